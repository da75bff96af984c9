"""What a report is called, and for whom and where the scan was made."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Heading:
    """The words at a report's top; what is empty is left out."""

    title: str = ""
    client: str = ""
    place: str = ""

    def subtitle(self, name: str) -> str:
        """Give the line below the title: client, place, and what was scanned.

        Args:
            name: What the report is about, such as the recording's name.
        """
        return " · ".join(word for word in (self.client, self.place, name) if word)

    def as_plain(self) -> dict[str, str | None]:
        """Give it for report.json; None for what is not said."""
        words = {"title": self.title, "client": self.client, "place": self.place}
        return {key: word or None for key, word in words.items()}


NO_HEADING = Heading()
"""A report that is called as all are."""
