"""The referee: sails a track in small steps and scores the route."""
