"""Shallow water: resistance, speed loss and squat."""
