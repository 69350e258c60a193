"""Tables and verdicts."""

from dataclasses import dataclass, field


def table(head, rows):
    """Markdown; every cell is text already."""
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def mib(size):
    return f"{size / 2**20:.1f} MiB"


@dataclass
class Section:
    """What a section found: `text` is Markdown, `figures` go to the JSON file."""

    title: str
    text: str = ""
    figures: dict = field(default_factory=dict)
    verdicts: list = field(default_factory=list)  # (what, measured, limit, passed)

    def judge(self, what, measured, limit, passed):
        self.verdicts.append((what, measured, limit, bool(passed)))

    def at_most(self, what, measured, limit, show="{:.3g}".format):
        self.judge(what, show(measured), f"at most {show(limit)}", measured <= limit)

    def at_least(self, what, measured, limit, show="{:.3g}".format):
        self.judge(what, show(measured), f"at least {show(limit)}", measured >= limit)

    def exactly(self, what, measured, wanted):
        self.judge(what, str(measured), str(wanted), measured == wanted)

    def markdown(self):
        rows = [[what, measured, limit, "pass" if passed else "**FAIL**"]
                for what, measured, limit, passed in self.verdicts]
        return (f"\n## {self.title}\n\n{self.text}\n"
                + table(["limit", "measured", "wanted", ""], rows))
