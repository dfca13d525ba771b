"""Questions on a terminal about a new case; what is given already is not asked."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import Console
from rich.prompt import Prompt
from rich.text import Text

from reports.new_case.templates import TEMPLATES, ChoiceError, Template, chosen_value


def asked_template(console: Console) -> Template:
    """The template that a person chooses by its number or name."""
    names = [template.name for template in TEMPLATES]
    for number, template in enumerate(TEMPLATES, 1):
        console.print(f"{number}  {template.name}: {template.words}")
    numbers = [str(number) for number in range(1, len(names) + 1)]
    answer = Prompt.ask(
        "Which kind of case", console=console, choices=[*numbers, *names], show_choices=False, default="1"
    )
    return TEMPLATES[numbers.index(answer) if answer in numbers else names.index(answer)]


def asked_title(console: Console, template: Template) -> str:
    """One line that says what the case is."""
    return Prompt.ask("Title", console=console, default=template.title)


def asked_choices(console: Console, template: Template, given: Mapping[str, str]) -> dict[str, str]:
    """What is given, with answers to what is not; an answer that cannot be taken is asked for again."""
    found = dict(given)
    for choice in template.choices:
        while choice.key not in found:
            answer = Prompt.ask(Text(choice.words.capitalize()), console=console, default=choice.default)
            try:
                chosen_value(choice, answer)
            except ChoiceError as error:
                console.print(Text(f"found {error}"))
                continue
            found[choice.key] = answer
    return found
