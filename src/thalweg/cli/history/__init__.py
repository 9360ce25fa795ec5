"""Commands on historic routes: ``thalweg history`` and ``thalweg distances``."""
