"""The example in the README runs as it stands."""

import re
from pathlib import Path

import plotly.graph_objects
import pytest

README = Path(__file__).parent.parent / "README.md"


def test_the_python_example_solves_and_plots(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = []
    monkeypatch.setattr(plotly.graph_objects.Figure, "show", lambda figure: shown.append(figure))
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), flags=re.DOTALL)

    exec(compile(code, "README.md", "exec"), {})

    assert capsys.readouterr().out.startswith("converged (Stretch(pair='touch'")
    assert len(shown[0].data[0].x) == 301
