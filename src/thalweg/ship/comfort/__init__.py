"""Motions of a ship at named places, what people and tasks on board make of them."""
