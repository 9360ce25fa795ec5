"""What a nautical chart holds: coastline, depth, zones and ports."""

from thalweg.chart.chart import Chart

__all__ = ["Chart"]
