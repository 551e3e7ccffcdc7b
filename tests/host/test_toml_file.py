"""Messages about TOML files: one line with the place and what is allowed."""

from typing import Annotated, Literal

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from chromadock.errors import ChromadockError
from chromadock.toml_file import one_line_error, read_toml
from chromadock.validation import allowed, between


class _Lamp(BaseModel):
    model_config = ConfigDict(extra="forbid")
    peak_nm: Annotated[float, between(400, 700, "nm")]
    name: Annotated[str, Field(min_length=1), allowed("a text")] = "lamp"


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid")
    distance_m: Annotated[float, Field(gt=0, le=50)] = 1.0
    water: Literal["pool", "lake"] = "pool"
    lamp: list[_Lamp] = []
    tint: tuple[float, float, float] = (1, 1, 1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("distance_m = -2", "distance_m is -2: it must be more than 0"),
        ("distance_m = 500", "distance_m is 500: it must be at most 50"),
        ("distance = 5", "unknown key distance: correct or remove it"),
        ('water = "sea"', "water is 'sea': it must be 'pool' or 'lake'"),
        ("lamp = 3", "lamp is 3: it must be a list"),
        ("lamp = [3]", "lamp, number 1 is 3: it must be a table of keys"),
        ("[[lamp]]\npeak_nm = 500\n[[lamp]]", "lamp 2: peak_nm is missing"),
        ("[[lamp]]\npeak_nm = 0.5", "lamp 1: peak_nm is 0.5: it must be 400 to 700 nm"),
        ('[[lamp]]\npeak_nm = "500"', "lamp 1: peak_nm is '500': it must be 400 to 700 nm"),
        ("[[lamp]]\npeak_nm = true", "lamp 1: peak_nm is True: it must be 400 to 700 nm"),
        ("[[lamp]]\npeak_nm = 500\nname = ''", "lamp 1: name is '': it must be a text"),
        ("[[lamp]]\npeak_nm = 500\ncolour = 3", "unknown key lamp 1: colour"),
        ("tint = [1, 'x', 1]", "tint, number 2 is 'x': it must be a valid number"),
        (f"water = '{'long ' * 60}'", "...: it must be 'pool' or 'lake'"),
    ],
)
def test_the_first_fault_is_told_in_one_line(tmp_path, text, says):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(ValidationError) as raised:
        _File.model_validate(read_toml(path))
    error = one_line_error(path, raised.value)
    assert isinstance(error, ChromadockError)
    line = str(error)
    assert line.startswith(f"{path}: ")
    assert says in line
    assert "\n" not in line
    assert len(line) - len(str(path)) < 120


def test_a_file_that_cannot_be_read_is_refused_with_the_mend(tmp_path):
    with pytest.raises(ChromadockError, match=r"none\.toml: cannot be read .*: give a scene"):
        read_toml(tmp_path / "none.toml", "give a scene")
    with pytest.raises(ChromadockError, match="cannot be read"):
        read_toml(tmp_path)


def test_a_file_that_is_no_toml_is_refused_with_the_line(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("a = 1\nb = = 2\n")
    with pytest.raises(ChromadockError, match=r"not valid TOML \(.*line 2"):
        read_toml(path)
