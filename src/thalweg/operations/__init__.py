"""Operations: work that repeats voyages between the same places, planned and measured."""
