"""Case files gone wrong, seeded: those of the library, and more, mutated as bytes, tokens, keys, types and values."""

from __future__ import annotations

import json
import math
import random
import re
import tomllib
from collections.abc import Callable
from typing import Any

# Left behind by text that was executed instead of read.
MARK = "rodcheck-was-here"
EXPRESSIONS = (
    f"__import__('pathlib').Path('{MARK}').touch()",
    f"$(touch {MARK})",
    f"`touch {MARK}`; touch {MARK}",
    "{{ 7 * 7 }}{% for x in [].__class__.__base__.__subclasses__() %}{% endfor %}",
    "{0.__class__.__mro__}",
    "%s%n",
    "9**9**9 mm",
    "1 mm**999999999",
    "1e999999999 mm",
    "(1 + 1) mm",
    "1 m m m m m m m m m m m m",
    "!!python/object/apply:os.system [id]",
)
PATHS = (
    "../../../../etc/passwd",
    "/etc/passwd",
    "e50_g0.json/../../library",
    "~/.ssh/id",
    "file:///etc/passwd",
    "C:\\nul",
    "..",
    "a\0b",
    "x" * 5000,
)
HTML = (
    "<script>alert(1)</script>",
    "</script><script>alert(1)//",
    '"><img src=x onerror=alert(1)>',
    "'; alert(1); '",
    "[red]rich[/] [/]",
    "&lt;b&gt; &amp; ]]>",
    "javascript:alert(1)",
)
UNICODE = (
    "\u202egnp.exe",
    "E\u0301\u0327 \u03bd \u6881 \U0001f4a5",
    "\ufeff",
    "\u2028\u2029",
    "\x1b[31mred\x1b[2J",
    "\x9b31m",
    "\x07\x08\x7f",
    "１５ mm",
    "15\u00a0mm",
    "\u0661\u0665 mm",
    "",
    " ",
    "\n",
)
TEXTS = (*EXPRESSIONS, *PATHS, *HTML, *UNICODE)
NUMBERS = (
    "nan", "-nan", "inf", "-inf", "0", "-0.0", "1e-400", "5e-324", "1e-30", "1e30", "1e31", "1e308", "1e400", "-1",
    "0.5", "1e-9", "2147483648", "18446744073709551616", "9" * 400, "9" * 5000, "0x7fffffff", "0b1", "1_000", "1e5",
    "true", "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", '"15"', '"15 mm"', '"1e400 mm"', '"nan mm"', '"-15 mm"',
    '"1 kN"', '"0.1 %"', '"90 deg"', '"1e30 km"', '"1e-30 mm"', "[]", "{}", "[0]", "[[0, 0, 0]]",
)  # fmt: skip
NO_TEXT = (b"\0", b"\xff\xfe", b"\xc3\x28", b"\xed\xa0\x80", b"\x1a", b"\r")
ODD: tuple[Callable[[random.Random], Any], ...] = (
    lambda rng: rng.choice(TEXTS),
    lambda _: None,
    lambda rng: rng.choice((True, False)),
    lambda rng: rng.choice((math.nan, math.inf, -math.inf, 0, -1, 1e-300, 1e300, 10**400, 2**63, 0.5, 3)),
    lambda _: [],
    lambda _: {},
    lambda rng: nested_list(rng.choice((3, 60, 150))),
    lambda rng: nested_table(rng.choice((3, 60, 150))),
    lambda rng: {rng.choice(TEXTS): 1 for _ in range(4)},
    lambda rng: [rng.choice(TEXTS) for _ in range(4)],
    lambda rng: [0.0] * rng.choice((1, 2, 4, 1000)),
    lambda rng: list(range(rng.choice((3, 1000, 20000)))),
    lambda rng: [[0.0, 0.0, float(n)] for n in range(rng.choice((3, 300)))],
)
_NUMBER = re.compile(r"(?<![\w.])[+-]?\d[\d_.]*(?:[eE][+-]?\d+)?")
_STRING = re.compile(r'"[^"\n]*"')
_TOKEN = re.compile(r'"""|"[^"\n]*"|[A-Za-z_][\w.]*|[+-]?\d[\d_.]*(?:[eE][+-]?\d+)?|\n|\S')


def mutated(seed: int, texts: list[str]) -> bytes:
    """A case file made from one of the texts by one to four mutations, the same for a seed and these texts."""
    rng = random.Random(seed)
    text = rng.choice(texts)
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        text = rng.choice(_TEXT_MUTATIONS)(rng, text, texts)
    return _in_bytes(rng, text.encode("utf-8", "surrogatepass")) if rng.random() < 0.15 else text.encode()


def toml(content: dict[str, Any]) -> str:
    """TOML text of tables, in inline form but for the outermost."""
    return "".join(f"{_string(key)} = {_value(each)}\n" for key, each in content.items())


def nested_list(depth: int) -> Any:
    """A list in a list in a list."""
    value: Any = 0
    for _ in range(depth):
        value = [value]
    return value


def nested_table(depth: int) -> Any:
    """A table in a table in a table."""
    value: Any = 0
    for _ in range(depth):
        value = {"a": value}
    return value


def _string(text: str) -> str:
    return json.dumps(text).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_string(key)} = {_value(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return _string(value) if isinstance(value, str) else '"None"' if value is None else repr(value)


def _places(node: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Keys and indices that lead to every value below a table or list."""
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    return [each for key, child in children for each in ((*place, key), *_places(child, (*place, key)))]


def _at(node: Any, place: tuple[Any, ...]) -> Any:
    for key in place:
        node = node[key]
    return node


def _as_tables(rng: random.Random, text: str, texts: list[str]) -> str:
    """Values, keys and whole tables replaced, taken away, moved and repeated in what the text says."""
    try:
        content = tomllib.loads(text)
        _change(rng, content)
        return toml(content)
    except (ValueError, RecursionError):  # no TOML any more, or too deep for what is done here
        return text


def _change(rng: random.Random, content: dict[str, Any]) -> None:
    for _ in range(rng.choice((1, 1, 2, 3))):
        places = _places(content)
        if not places:
            break
        *above, key = rng.choice(places)
        parent = _at(content, tuple(above))
        match rng.randrange(6):
            case 0:
                parent[key] = rng.choice(ODD)(rng)
            case 1:
                del parent[key]
            case 2 if isinstance(parent, dict):
                parent[rng.choice((*TEXTS, "rod", "shape", "kind", "__class__", key + "s"))] = parent.pop(key)
            case 3:
                parent[key] = json.loads(json.dumps(_at(content, rng.choice(places)), default=str))
            case 4 if isinstance(parent, list):
                parent *= rng.choice((2, 50))
            case _:
                parent[key] = {"x": parent[key]} if rng.random() < 0.5 else [parent[key]] * rng.choice((1, 2, 3))


def _in_bytes(rng: random.Random, data: bytes) -> bytes:
    """Bytes flipped, cut, repeated, or put in that are no text."""
    at, to = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    match rng.randrange(5):
        case 0:
            return data[:at]
        case 1:
            return data[:at] + rng.choice(NO_TEXT) + data[at:]
        case 2:
            return data[:at] + data[to:]
        case 3:
            return data[:to] + data[at:]
        case _:
            found = bytearray(data)
            for _ in range(min(rng.choice((1, 5, 50)), len(data))):
                found[rng.randrange(len(data))] = rng.randrange(256)
            return bytes(found)


def _another_number(rng: random.Random, text: str, texts: list[str]) -> str:
    return _replaced(rng, text, _NUMBER, lambda number: rng.choice((*NUMBERS, *_near(number))))


def _near(number: str) -> tuple[str, ...]:
    """Numbers that could almost be meant, as often as the others."""
    return (
        f"-{number}",
        f"{number}e{number[:2]}",
        *(f"{number}{share}" for share in ("e-9", "e-3", "e-1", "e1", "e3", "1")),
    )


def _another_string(rng: random.Random, text: str, texts: list[str]) -> str:
    other = rng.choice((*TEXTS, rng.choice(_STRING.findall(rng.choice(texts)) or [""]).strip('"')))
    return _replaced(rng, text, _STRING, lambda _: _string(other))


def _replaced(rng: random.Random, text: str, pattern: re.Pattern[str], new: Callable[[str], str]) -> str:
    found = list(pattern.finditer(text))
    if not found:
        return text
    match = rng.choice(found)
    return text[: match.start()] + new(match[0]) + text[match.end() :]


def _other_tokens(rng: random.Random, text: str, texts: list[str]) -> str:
    """A token taken away, repeated, exchanged for another one of this or another file."""
    tokens = list(_TOKEN.finditer(text))
    if not tokens:
        return text
    match = rng.choice(tokens)
    others = _TOKEN.findall(rng.choice(texts))
    new = rng.choice(("", match[0] * 2, match[0] + " " + match[0], rng.choice(others), rng.choice(tokens)[0]))
    return text[: match.start()] + new + text[match.end() :]


def _other_lines(rng: random.Random, text: str, texts: list[str]) -> str:
    """Lines taken away, repeated, shuffled or brought in from another file."""
    lines = text.splitlines()
    if not lines:
        return text
    at = rng.randrange(len(lines))
    others = rng.choice(texts).splitlines()
    match rng.randrange(4):
        case 0:
            del lines[at : at + rng.choice((1, 1, 3, 10))]
        case 1:
            lines.insert(at, rng.choice(lines))
        case 2:
            lines.insert(at, rng.choice(others))
        case _:
            start = rng.randrange(len(others))
            lines[at:at] = others[start : start + rng.choice((2, 8))]
    return "\n".join(lines) + "\n"


def _deep(rng: random.Random, text: str, texts: list[str]) -> str:
    depth = rng.choice((50, 200, 400, 5000, 100_000))
    return text + rng.choice(
        (
            "\nx = " + "[" * depth + "]" * depth,
            "\nx = " + "{a = " * min(depth, 5000) + "1" + "}" * min(depth, 5000),
            "\n" + ".".join(["a"] * min(depth, 5000)) + " = 1",
            "\n[" + ".".join(["materials"] + ["a"] * min(depth, 5000)) + "]\n",
            "\n[[loads]]\nkind = [{" + ".".join(["a"] * min(depth, 5000)) + " = 1}]\n",
        )
    )


def _large(rng: random.Random, text: str, texts: list[str]) -> str:
    """One thing of which there is far too much."""
    count = rng.choice((1000, 30_000))
    match rng.randrange(6):
        case 0:
            return text + "".join(
                f"\n[materials.m{n}]\nyoung_modulus = 1\npoisson_ratio = 0\n" for n in range(count // 10)
            )
        case 1:
            return text + "".join(f"\nkey_{n} = {n}" for n in range(count))
        case 2:
            borders = "element_borders = [" + ", ".join(map(str, range(count))) + "]"
            return re.sub(r"element_borders = \[[^\]]*\]", borders, text, count=1)
        case 3:
            return re.sub(r'title = "[^"]*"', f'title = "{"long " * count}"', text, count=1)
        case 4:
            return text + f"\n{'k' * count} = 1\n"
        case _:
            points = ", ".join(f"[{n}, {(n * n) % 7}]" for n in range(count // 10))
            return text + f'\n[sections.many]\nshape = "polygon"\nouter = [{points}]\n'


_TEXT_MUTATIONS: tuple[Callable[[random.Random, str, list[str]], str], ...] = (
    _as_tables, _as_tables, _as_tables, _another_number, _another_number, _another_string, _another_string,
    _other_tokens, _other_tokens, _other_lines, _deep, _large,
)  # fmt: skip
