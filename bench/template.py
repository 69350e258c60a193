"""Pages whose prose is a template and whose figures are measured."""

import re
import sys


def fill(template, pieces):
    """The text of the file `template` with every {{name}} replaced; all pieces must be used."""
    text = template.read_text()
    names = set(re.findall(r"\{\{(\w+)\}\}", text))
    if names != set(pieces):
        sys.exit(f"{template.name}: {', '.join(sorted(names ^ set(pieces)))}: not in both")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: pieces[match.group(1)].rstrip("\n"), text)
