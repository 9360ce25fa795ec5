"""Other spellings of the names of ports: hyphens, spaces and transliterations."""

import pytest

from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.port_names import loose_port_names, normalised_port_name
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import resolve_endpoint
from thalweg.planning.seaways import world_chart


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
    ("text", "position"),
    [
        ("Vizag", (17.69, 83.28)),
        ("JNPT", (18.95, 72.95)),
        ("Beilun", (29.94, 121.89)),
        ("Dalrymple Bay", (-21.26, 149.30)),
        ("Deltaport", (49.02, -123.16)),
        ("Ponta da Madeira", (-2.56, -44.38)),
        ("Porto do Acu", (-21.83, -40.98)),
        ("Caofeidian", (38.92, 118.50)),
        ("Matola", (-25.97, 32.50)),
        ("Koror", (7.34, 134.48)),
        ("Kharg Island", (29.23, 50.33)),
        ("Stade", (53.64, 9.50)),
    ],
)
def test_names_that_planners_use_lead_to_the_berths(text, position):
    port = PORTS.lookup(text)
    assert (port.lat, port.lon) == pytest.approx(position, abs=0.1)
    assert PORT_APPROACHES.of(port).length < 60.0 * NAUTICAL_MILE


@pytest.mark.parametrize(
    ("text", "locode"),
    [
        ("Houston, TX", "USHOU"),
        ("Houston, Texas", "USHOU"),
        ("Portland, ME", "USPWM"),
        ("Portland, OR", "USPDX"),
        ("Vancouver, BC", "CAVAN"),
        ("Vancouver, WA", "USVAN"),
        ("Savannah, GA", "USSAV"),  # GA is also Gabon
        ("Bar, ME", "MEBAR"),  # Montenegro, not Maine
        ("Fremantle, WA", "AUFRE"),
        ("Newcastle, NSW", "AUNTL"),
    ],
)
def test_a_state_or_province_stands_in_place_of_the_country(text, locode):
    assert PORTS.lookup(text).locode == locode


def test_a_port_in_another_state_is_refused():
    with pytest.raises(InputError, match="no port named 'Savannah' in 'TX'"):
        PORTS.lookup("Savannah, TX")


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


def test_only_names_that_a_word_may_be_a_slip_of_are_listed():
    """Elblag, when it was not in the table, was answered with Port Kembla and Port Klang."""
    with pytest.raises(InputError, match=r"Nearest in spelling: Rotterdam, NL \(NLRTM\)\."):
        PORTS.lookup("Rotterdan")
    with pytest.raises(InputError, match="no port named 'Qwmlxag' in the table of ports") as caught:
        PORTS.lookup("Qwmlxag")
    assert "Nearest" not in str(caught.value) and "Check the spelling" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "unlike"), [("Sukhoy", True), ("Danzig", True), ("Bombay", False), ("Ymuiden", False)]
)
def test_a_former_name_that_is_unlike_the_name_of_its_port_is_known(name, unlike):
    assert PORTS.is_unlike(name, PORTS.lookup(name)) is unlike


@pytest.mark.slow
def test_a_plan_from_a_former_name_asks_to_see_whether_the_port_is_meant():
    """Funchal - Porto Santo was planned to Vanuatu, by a former name of Luganville."""
    end = resolve_endpoint("Sukhoy", world_chart(), "start")
    assert (
        end.note
        == "A former or local name of Chornomorsk, UA (UAILK): Sukhoy. See that it is meant."
    )
    assert resolve_endpoint("Bombay", world_chart(), "start").note == ""
