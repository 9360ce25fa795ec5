from thalweg.chart.chart import Chart

__all__ = ["Chart"]
