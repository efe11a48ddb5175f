"""The one kind of error of this room."""


class PlotError(Exception):
    """Something the user can put right; its text is one sentence that names the file, the thing and what is allowed."""
