"""Line charts as SVG: panels side by side, one legend at their right.

The same input gives the same text. Values that an axis cannot show (none, or not above 0 on a
logarithmic axis) are left out of their line.
"""

import math
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#aa3377", "#b8860b", "#56b4e9", "#222222", "#ee6677",
           "#7d5fb2", "#8c8c8c", "#5b7f00"]
DASHES = {"solid": "", "dashed": "6 3", "dotted": "1.5 3"}  # "none": marks alone

TOP, BOTTOM, LEFT, GAP, LEGEND = 34, 48, 78, 92, 16  # around the panels
ROW = 18  # of the legend
LETTER = 7.4  # a letter's width, for the legend


def colour(number):
    return COLOURS[number % len(COLOURS)]


@dataclass
class Series:
    label: str
    points: list  # (x, y)
    colour: str
    dash: str = "solid"  # of DASHES, or "none"
    marks: bool = True


@dataclass
class Axis:
    label: str
    log: bool = True
    from_zero: bool = False  # linear axes only
    names: dict = field(default_factory=dict)  # tick: text; {} to choose ticks

    def shows(self, value):
        return value is not None and (value > 0 or not self.log)

    def scale(self, value):
        return math.log10(value) if self.log else value


@dataclass
class Panel:
    title: str
    x: Axis
    y: Axis
    series: list


def chart(panels, width=360, height=340):
    """SVG text of the panels, each of that size without its labels."""
    legend = {series.label: series for panel in panels for series in panel.series}
    legend_width = LEGEND + 38 + LETTER * max(len(label) for label in legend)
    left = LEFT
    parts = []
    for panel in panels:
        parts += draw_panel(panel, left, width, height)
        left += width + GAP
    right = left - GAP
    parts += draw_legend(legend.values(), right + LEGEND)
    full_height = max(TOP + height + BOTTOM, TOP + ROW * len(legend) + 10)
    return document(right + legend_width, full_height, parts)


def document(width, height, parts):
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
         f'width="{width:.0f}" height="{height:.0f}" font-family="sans-serif" font-size="12">',
         '<rect width="100%" height="100%" fill="#ffffff"/>', *parts, "</svg>"]) + "\n"


def draw_panel(panel, left, width, height):
    shown = [[point for point in series.points
              if panel.x.shows(point[0]) and panel.y.shows(point[1])] for series in panel.series]
    points = [point for of_series in shown for point in of_series]
    x_range = extent([panel.x.scale(x) for x, _ in points], panel.x)
    y_range = extent([panel.y.scale(y) for _, y in points], panel.y)

    def place_x(value):
        return left + width * share(panel.x.scale(value), x_range)

    def place_y(value):
        return TOP + height * (1 - share(panel.y.scale(value), y_range))

    parts = [text(left + width / 2, TOP - 14, panel.title, "middle", "bold"),
             text(left + width / 2, TOP + height + 38, panel.x.label, "middle"),
             text(left - 62, TOP + height / 2, panel.y.label, "middle", turned=True)]
    for value, name in ticks(panel.x, x_range):
        at = place_x(value)
        parts += [line([(at, TOP), (at, TOP + height)], "#e4e4e4"),
                  text(at, TOP + height + 17, name, "middle")]
    for value, name in ticks(panel.y, y_range):
        at = place_y(value)
        parts += [line([(left, at), (left + width, at)], "#e4e4e4"),
                  text(left - 6, at + 4, name, "end")]
    parts.append(f'<rect x="{left}" y="{TOP}" width="{width}" height="{height}" fill="none" '
                 'stroke="#777777"/>')
    # Solid lines first, so that others show where they coincide.
    for series, of_series in sorted(zip(panel.series, shown), key=lambda s: s[0].dash != "solid"):
        parts += draw_series(series, [(place_x(x), place_y(y)) for x, y in of_series])
    return parts


def draw_series(series, places):
    parts = []
    if series.dash in DASHES and len(places) > 1:
        parts.append(line(places, series.colour, DASHES[series.dash], 1.7))
    if series.marks:
        parts += [mark(place, series) for place in places]
    return parts


def draw_legend(series, left):
    parts = []
    for row, one in enumerate(series):
        y = TOP + 8 + ROW * row
        if one.dash in DASHES:
            parts.append(line([(left, y), (left + 26, y)], one.colour, DASHES[one.dash], 1.7))
        if one.marks:
            parts.append(mark((left + 13, y), one))
        parts.append(text(left + 32, y + 4, one.label, "start"))
    return parts


def mark(place, series):
    fill = "none" if series.dash in ("dashed", "dotted") else series.colour
    return (f'<circle cx="{place[0]:.1f}" cy="{place[1]:.1f}" r="2.8" fill="{fill}" '
            f'stroke="{series.colour}" stroke-width="1.3"/>')


def line(places, colour, dash="", width=1.0):
    route = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return (f'<polyline points="{route}" fill="none" stroke="{colour}" '
            f'stroke-width="{width}"{dashes}/>')


def text(x, y, words, anchor, weight="normal", turned=False):
    turn = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if turned else ""
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" '
            f'font-weight="{weight}"{turn}>{escape(words)}</text>')


def share(value, value_range):
    low, high = value_range
    return (value - low) / (high - low)


def extent(scaled, axis):
    """The axis' range, with some air."""
    low, high = min(scaled), max(scaled)
    if axis.from_zero:
        return 0, 1.08 * high
    air = 0.05 * (high - low) or 0.5
    return low - air, high + air


def ticks(axis, scaled_range):
    """[(value, text)]"""
    low, high = scaled_range
    if axis.names:
        return [(v, name) for v, name in axis.names.items() if low <= axis.scale(v) <= high]
    if axis.log:
        decades = range(math.floor(low), math.ceil(high) + 1)
        digits = (1, 2, 5) if high - low < 2.5 else (1,)
        step = 1 if high - low < 7 else 2
        values = [digit * 10.0**decade for decade in decades for digit in digits
                  if decade % step == 0]
    else:
        rough = (high - low) / 6
        power = 10.0 ** math.floor(math.log10(rough))
        step = next(power * m for m in (1, 2, 5, 10) if power * m >= rough)
        values = [step * i for i in range(math.ceil(low / step), math.floor(high / step) + 1)]
    return [(value, name_of(value)) for value in values if low <= axis.scale(value) <= high]


def name_of(value):
    return f"{value:,.0f}" if value >= 1000 else f"{value:.6g}"
