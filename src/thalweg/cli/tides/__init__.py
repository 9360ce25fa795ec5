"""The command ``thalweg tides`` and its actions."""
