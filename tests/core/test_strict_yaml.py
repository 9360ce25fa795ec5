"""YAML of plain data: what is refused, and that written text can be read again."""

import pytest

from thalweg.core.errors import InputError
from thalweg.core.strict_yaml import dump_yaml, parse_yaml
from thalweg.operations.dredging.project import Project
from thalweg.planning.voyage import Voyage


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("start: a\nstart: b\n", "line 2.*'start' is given twice"),
        ("start: &a [1, 2]\ngoal: *a\n", "line 2.*references"),
        ("start: !!python/object:os.system x\n", "line 1"),
        ("start: [1, 2\n", "line 2"),
        ("start: 2020-13-45\n", "month"),
        (
            "a: 1\nhull: {depth_m: 19.1, draught_m: 11,8, breadth_m: 30}",
            "line 2.*'draught_m: 11.8'",
        ),
        ("{hull: {draught_m: 11,08}}", "Was a decimal comma meant.*'draught_m: 11.08'"),
        ("tasks: {work: {min_m: -1,5, max_m: 2,5}}", "'min_m: -1.5'"),
        ("places: {bridge: 45,5}", "'bridge: 45.5'"),
    ],
)
def test_faults_are_refused_with_the_line(tmp_path, text, message):
    with pytest.raises(InputError, match=f"The voyage file v.yaml cannot be read.*{message}"):
        parse_yaml(text, "voyage", "v.yaml")
    path = tmp_path / "v.yaml"
    path.write_text(text, encoding="utf-8")
    for kind in (Voyage, Project):
        with pytest.raises(InputError, match=message):
            kind.load(path)


def test_values_that_occur_twice_can_be_read_again():
    place = [52.0, 4.0]
    data = {"goal": place, "start": place}
    assert parse_yaml(dump_yaml(data), "voyage", "v.yaml") == data


def test_json_is_read():
    assert parse_yaml('{"a": [1, 2.5, null, true]}', "voyage", "v") == {"a": [1, 2.5, None, True]}
