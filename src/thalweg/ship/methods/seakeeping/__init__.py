"""Seakeeping: motions, sickness, wave spectra, stability in following seas."""
