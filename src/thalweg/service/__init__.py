"""The web application and its interface for programs: ``thalweg serve``."""
