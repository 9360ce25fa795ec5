"""Networks of the routes that ships have taken, made from tracks."""
