"""The answers of the interface: their form and an example of each."""
