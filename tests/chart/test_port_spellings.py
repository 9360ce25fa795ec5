"""Other spellings of the names of ports: hyphens, spaces and transliterations."""

import pytest

from thalweg.chart.port_names import loose_port_names, normalised_port_name
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError


@pytest.mark.parametrize(
    ("text", "locode"),
    [
        ("Petropavlovsk-Kamchatskiy", "RUPKC"),
        ("Petropavlovsk Kamchatsky", "RUPKC"),
        ("Petropavlovsk-Kamchatskij, RU", "RUPKC"),
        ("Novorossijsk", "RUNVS"),
        ("Yuzhny", "UAYZE"),
        ("Le-Havre", "FRLEH"),
        ("Portsaid", "EGPSD"),
    ],
)
def test_one_port_is_found_by_other_spellings(text, locode):
    assert PORTS.lookup(text).locode == locode
    assert PORTS.find(text).locode == locode


@pytest.mark.parametrize(
    "text", ["Rotterdam Airport", "Rotterdamski", "Petropavlovsk-Kamchatskiy, JP", "Kamchatskiy"]
)
def test_other_words_are_no_spellings(text):
    with pytest.raises(InputError, match="There is no port named"):
        PORTS.lookup(text)


def test_every_exact_name_finds_what_it_found_before():
    """Loose forms are used only where no port has the name."""
    for name, ports in list(PORTS._by_name.items())[::7]:
        assert PORTS._with_name(name) == ports


def test_loose_forms():
    name = normalised_port_name("Petropavlovsk-Kamchatskiy")
    assert loose_port_names(name) == ("petropavlovskkamchatski", "petropavlovsk")
    assert loose_port_names("kyiv") == ()
