"""Plans that trade time against fuel, energy, cost or emissions."""
