"""Long random campaigns, run by hand: ``python -m tests.campaigns.NAME --count N --seed S``.

They are not part of the test suite (no module is named ``test_``). Each prints its figures and ends
with exit code 1 if it found a difference.
"""
