# SPDX-License-Identifier: Apache-2.0
"""Plots of lines on logarithmic axes, as SVG text."""
import html
import math

WIDTH, HEIGHT = 680, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 230, 34, 46
COLOURS = ('#0b5fa5', '#c2410c', '#3f7d20', '#7b3fa0', '#946c00', '#444444')


class Axis:
    """A logarithmic axis from `low` to `high`, drawn from the pixel `start` to the pixel `end`."""

    def __init__(self, values, start, end):
        self.low = math.log10(min(values)) - 0.05
        self.high = max(math.log10(max(values)) + 0.05, self.low + 0.2)
        self.start, self.end = start, end

    def place(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self):
        """1, 2 and 5 times the powers of ten on the axis, or the powers alone if these are many."""
        powers = range(math.floor(self.low), math.ceil(self.high) + 1)
        factors = (1, 2, 5) if len(powers) < 5 else (1,)
        values = [f * 10.0 ** p for p in powers for f in factors]
        return [v for v in values if self.low <= math.log10(v) <= self.high]


def svg(title, x_label, y_label, lines):
    """A plot of `lines`: tuples of a label, points (x, low, y, high), and whether the line is dashed. Lines of one label have one
    colour. The range from low to high is a bar."""
    points = [p for _, line, _ in lines for p in line]
    x_axis = Axis([p[0] for p in points], LEFT, WIDTH - RIGHT)
    y_axis = Axis([v for p in points for v in p[1:]], HEIGHT - BOTTOM, TOP)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', text(LEFT, 20, title, 'start', 14)]
    parts += frame(x_axis, y_axis, x_label, y_label)
    colours = {label: COLOURS[i % len(COLOURS)] for i, label in enumerate(dict.fromkeys(label for label, _, _ in lines))}
    for row, (label, line, dashed) in enumerate(lines):
        parts += drawn(line, colours[label], dashed, x_axis, y_axis)
        y = TOP + 14 + 18 * row
        parts.append(stroke([(WIDTH - RIGHT + 12, y - 4), (WIDTH - RIGHT + 36, y - 4)], colours[label], dashed))
        parts.append(text(WIDTH - RIGHT + 42, y, label + (', denoised' if dashed else ''), 'start'))
    return '\n'.join(parts) + '\n</svg>\n'


def frame(x_axis, y_axis, x_label, y_label):
    grid = []
    for value in x_axis.ticks():
        x = x_axis.place(value)
        grid += [stroke([(x, TOP), (x, HEIGHT - BOTTOM)], '#dddddd'), text(x, HEIGHT - BOTTOM + 16, f'{value:g}', 'middle')]
    for value in y_axis.ticks():
        y = y_axis.place(value)
        grid += [stroke([(LEFT, y), (WIDTH - RIGHT, y)], '#dddddd'), text(LEFT - 6, y + 4, f'{value:g}', 'end')]
    middle = (TOP + HEIGHT - BOTTOM) / 2
    return grid + [text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, x_label, 'middle'),
                   f'<g transform="rotate(-90 16 {middle})">{text(16, middle, y_label, "middle")}</g>']


def drawn(line, colour, dashed, x_axis, y_axis):
    places = [(x_axis.place(x), y_axis.place(y)) for x, _, y, _ in line]
    bars = [stroke([(x_axis.place(x), y_axis.place(low)), (x_axis.place(x), y_axis.place(high))], colour) for x, low, _, high in line]
    dots = [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{colour}"/>' for x, y in places]
    return [stroke(places, colour, dashed, 2), *bars, *dots]


def stroke(places, colour, dashed=False, width=1):
    path = ' '.join(f'{x:.1f},{y:.1f}' for x, y in places)
    dashes = ' stroke-dasharray="6 4"' if dashed else ''
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"{dashes}/>'


def text(x, y, words, anchor, size=12):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}">{html.escape(words)}</text>'
