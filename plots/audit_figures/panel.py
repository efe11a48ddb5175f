"""What the page asks of a panel: its size before it is drawn, and what in it the caption must explain."""

from common.paper import add_text


class Panel:
    span = 2  # columns of the page

    def height(self, width):
        """Inches below the title."""
        raise NotImplementedError

    def draw(self, figure, left, top, width):
        """Places are inches from the upper left corner of the figure."""
        raise NotImplementedError

    def cuts_intervals(self):
        return False

    def has_pale_series(self):
        return False

    def shows_limit(self):
        return False


class EmptyPanel(Panel):
    """A claim without a single target."""

    def height(self, width):
        return 0.16

    def draw(self, figure, left, top, width):
        add_text(figure, left, top, "no evidence in the file", fontsize=7.5, style="italic", color="0.35")
