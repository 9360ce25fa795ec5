"""Work with the files of users outside the server process, within limits of time and memory."""
