"""Files of ports for tables of distances."""

import pytest

from thalweg import InputError
from thalweg.planning.distance_table import read_places


def test_a_name_with_a_comma_without_quotation_marks_is_refused(tmp_path):
    path = tmp_path / "ports.csv"
    path.write_text("port\nPortsmouth, US\n")  # without the country it is another port
    with pytest.raises(InputError, match="Line 2 of the ports has more fields") as refused:
        read_places(path)
    assert 'Write "Portsmouth, US"' in refused.value.remedy
    path.write_text('port\n"Portsmouth, US"\nNLRTM\n')
    assert read_places(path) == [("Portsmouth, US",) * 2, ("NLRTM",) * 2]
