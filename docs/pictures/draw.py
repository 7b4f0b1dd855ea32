#!/usr/bin/env python3
"""Draws the pictures of docs/concepts. Directions and signs follow from the conventions below by formulas.

`python3 docs/pictures/draw.py` writes the pictures anew, with `--check` it says whether they are up to date.
Conventions (crates/shared/basis, crates/controller/control/src/excitation.rs): x downwind, y left looking
downwind, z up; azimuth 0 is up and grows clockwise looking downwind; tilt is the cosine, yaw the sine component
over azimuth; a helix commands tilt = A sin(angle) and yaw = A sin(angle + 90 deg) (ccw) or A sin(angle - 90 deg) (cw).
"""

import sys
from math import atan2, cos, degrees, radians, sin
from pathlib import Path

INK, PALE, WATER, BLUE, RED, GREEN = "#22303c", "#c9d3da", "#eef4f8", "#1f6fb2", "#c8442e", "#2f8a4e"


def disc(azimuth_deg, radius=1.0):
    """Point at `azimuth_deg` seen looking downwind, as (right, up): z is up, and right is -y."""
    y, z = -radius * sin(radians(azimuth_deg)), radius * cos(radians(azimuth_deg))
    return -y, z


def helix(angle_deg, sense):
    """Tilt and yaw of a helix of amplitude 1 at `angle_deg` of its period; `sense`: +1 ccw, -1 cw."""
    return sin(radians(angle_deg)), sin(radians(angle_deg + 90 * sense))


def azimuth_of_most(tilt, yaw):
    """Azimuth (deg) at which tilt cos + yaw sin is greatest."""
    return degrees(atan2(yaw, tilt))


class Picture:
    """Shapes on a white sheet; positions in pixels, y downwards."""

    def __init__(self, width, height, title):
        self.size, self.title, self.parts = (width, height), title, []

    def line(self, points, color=INK, width=2, dashes=None, arrow=False, fill="none", closed=False):
        path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + ("Z" if closed else "")
        extra = f' stroke-dasharray="{dashes}"' if dashes else ""
        self.parts.append(
            f'<path d="{path}" fill="{fill}" stroke="{color}" stroke-width="{width}"{extra}/>'
        )
        if arrow:
            self.head(points[-2], points[-1], color)

    def head(self, before, tip, color):
        turn = atan2(tip[1] - before[1], tip[0] - before[0])
        corners = [(tip[0] + 5 * cos(turn), tip[1] + 5 * sin(turn))]
        corners += [
            (tip[0] - 8 * cos(turn + side), tip[1] - 8 * sin(turn + side)) for side in (0.45, -0.45)
        ]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
        self.parts.append(f'<polygon points="{path}" fill="{color}"/>')

    def circle(self, center, radius, color=INK, width=2, fill="none", dashes=None):
        extra = f' stroke-dasharray="{dashes}"' if dashes else ""
        x, y = center
        self.parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{fill}" stroke="{color}"'
            f' stroke-width="{width}"{extra}/>'
        )

    def text(self, at, words, color=INK, anchor="middle", size=15, bold=False):
        weight = ' font-weight="bold"' if bold else ""
        x, y = at
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" fill="{color}" text-anchor="{anchor}" font-size="{size}"'
            f"{weight}>{words}</text>"
        )

    def arc(self, center, radius, first_deg, last_deg, color=INK, width=2, arrow=True):
        """An arc over azimuths, seen looking downwind."""
        n = max(8, int(abs(last_deg - first_deg) / 3))
        azimuths = [first_deg + (last_deg - first_deg) * i / n for i in range(n + 1)]
        self.line([on(center, azimuth, radius) for azimuth in azimuths], color, width, arrow=arrow)

    def svg(self):
        width, height = self.size
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}"'
                f' height="{height}" font-family="Helvetica, Arial, sans-serif" role="img">',
                f"<title>{self.title}</title>",
                f'<rect width="{width}" height="{height}" rx="6" fill="white"/>',
                *self.parts,
                "</svg>",
                "",
            ]
        )


def on(center, azimuth_deg, radius):
    """The pixel at `azimuth_deg` on a disc around `center`, seen looking downwind."""
    right, up = disc(azimuth_deg, radius)
    return center[0] + right, center[1] - up


def blade(picture, center, azimuth_deg, radius, color=INK):
    """A blade from the hub outwards, a little wider inboard and behind its leading edge."""
    steps = [(0.06, 0), (0.22, 9), (1, 1.5), (1, 0), (0.06, -2)]
    points = []
    for share, behind in steps:
        x, y = on(center, azimuth_deg, share * radius)
        across = on((0, 0), azimuth_deg - 90, behind)
        points.append((x + across[0], y + across[1]))
    picture.line(points, color, 1.5, fill="#dfe7ed", closed=True)


def turbine_from_the_side(picture, foot, height, radius, name):
    """A turbine from its right side: wind from the left, the rotor upwind of the tower."""
    x, ground = foot
    hub = (x - 12, ground - height)
    picture.line(
        [(x - 5, ground), (x - 3, hub[1] + 6), (x + 3, hub[1] + 6), (x + 5, ground)],
        fill="#dfe7ed",
        width=1.5,
    )
    picture.line(
        [(hub[0], hub[1] - 6), (x + 18, hub[1] - 6), (x + 18, hub[1] + 6), (hub[0], hub[1] + 6)],
        fill="#dfe7ed",
        width=1.5,
        closed=True,
    )
    picture.line([(hub[0], hub[1] - radius), (hub[0], hub[1] + radius)], width=4)
    picture.text((x + 26, hub[1] - 12), name, bold=True, anchor="start")


def frames():
    picture = Picture(720, 470, "The farm frame: x downwind, y to the left looking downwind, z up")
    picture.text((20, 28), "from the side (seen from −y)", anchor="start", bold=True)
    ground = 230
    picture.line([(20, ground), (700, ground)], PALE, 3)
    for height in (70, 110, 150):
        picture.line([(20, height), (70, height)], BLUE, 2, arrow=True)
    picture.text((45, 58), "wind", BLUE)
    first, second = (170, ground), (530, ground)
    turbine_from_the_side(picture, first, 120, 72, "T1")
    turbine_from_the_side(picture, second, 120, 72, "T2")
    picture.line([first, (300, ground)], RED, 3, arrow=True)
    picture.text((312, ground - 8), "x downwind", RED, "start")
    picture.line([first, (170, ground - 70)], RED, 3, arrow=True)
    picture.text((182, ground - 62), "z up", RED, "start")
    picture.circle(first, 5, RED, fill="white")
    picture.line([(166.5, ground - 3.5), (173.5, ground + 3.5)], RED, 1.5)
    picture.line([(166.5, ground + 3.5), (173.5, ground - 3.5)], RED, 1.5)
    picture.text((170, ground + 24), "origin; y away from you", RED)
    picture.line([(530, ground), (530, ground + 14)], PALE, 1)
    picture.text((530, ground + 24), "position [5, 0] diameters")
    picture.text((20, 290), "from above", anchor="start", bold=True)
    for y in (350, 390, 430):
        picture.line([(20, y), (70, y)], BLUE, 2, arrow=True)
    center = 390
    for x, y, name in ((170, center, "T1  [0, 0]"), (530, center - 45, "T2  [5, 0.6]")):
        picture.line([(x - 12, y - 45), (x - 12, y + 45)], width=4)
        picture.line(
            [(x - 12, y - 6), (x + 18, y - 6), (x + 18, y + 6), (x - 12, y + 6)],
            fill="#dfe7ed",
            width=1.5,
            closed=True,
        )
        picture.text((x + 26, y - 12), name, anchor="start", bold=True)
    picture.line([(170, center), (300, center)], RED, 3, arrow=True)
    picture.text((312, center + 5), "x downwind", RED, "start")
    picture.line([(170, center), (170, center - 75)], RED, 3, arrow=True)
    picture.text((182, center - 70), "y left, looking downwind", RED, "start")
    picture.circle((170, center), 5, RED, fill="white")
    picture.circle((170, center), 1.5, RED, fill=RED)
    picture.text((170, center + 66), "z towards you", RED)
    picture.line([(200, center), (530, center)], PALE, 1, "4 4")
    return picture


def azimuth():
    picture = Picture(760, 380, "Azimuth and blades, tilt and yaw, looking downwind")
    left, radius, now = (205, 200), 115, 40
    picture.text((205, 28), "looking downwind, seen from upwind", bold=True)
    picture.circle(left, radius, PALE, 1.5, dashes="4 4")
    picture.line(
        [(left[0] - 3, left[1]), (left[0] - 5, 365), (left[0] + 5, 365), (left[0] + 3, left[1])],
        PALE,
        1.5,
        fill="#f4f6f8",
    )
    for number in (1, 2, 3):
        at = now + 120 * (number - 1)
        blade(picture, left, at, radius)
        x, y = on(left, at, radius + 17)
        picture.text((x, y + 5), str(number), bold=True)
    picture.circle(left, 9, fill="white")
    picture.line([left, on(left, 0, radius + 8)], RED, 1, "5 4")
    picture.arc(left, 62, 0, now - 2, RED)
    x, y = on(left, now / 2, 78)
    picture.text((x, y), "ψ", RED, size=18)
    picture.arc(left, radius + 18, 118, 146, BLUE)
    x, y = on(left, 132, radius + 26)
    picture.text((x, y + 12), "turns", BLUE, "start")
    x, y = on(left, 0, radius + 14)
    picture.text((x, y), "0°", RED)
    for at, words, anchor in ((90, "90° (−y)", "start"), (270, "270° (+y)", "end")):
        x, y = on(left, at, radius + 6)
        picture.line([on(left, at, radius - 6), (x, y)], RED, 1.5)
        picture.text((x + (4 if anchor == "start" else -4), y + 5), words, RED, anchor, 13)
    for center, words, most in (((485, 150), "tilt &gt; 0", 0), ((660, 150), "yaw &gt; 0", 90)):
        half = [on(center, most - 90 + 6 * i, 66) for i in range(31)]
        picture.line(half, BLUE, 0.5, fill="#cfe3f3", closed=True)
        picture.circle(center, 66)
        x, y = on(center, most, 38)
        picture.text((x, y + 6), "more", BLUE)
        x, y = on(center, most + 180, 38)
        picture.text((x, y + 6), "less")
        picture.text((center[0], 60), words, bold=True)
    picture.text((485, 245), "upper half", size=13)
    picture.text((660, 245), "right half", size=13)
    picture.text((565, 290), "value at blade i = average + tilt cos ψᵢ + yaw sin ψᵢ", size=14)
    picture.text((565, 316), "tilt = (2/n) Σ xᵢ cos ψᵢ,  yaw = (2/n) Σ xᵢ sin ψᵢ", size=14)
    return picture


def pitch():
    picture = Picture(720, 300, "Pitch is positive to feather")
    picture.text((20, 28), "blade 1 up, seen from above its tip", anchor="start", bold=True)
    for y in (90, 150, 210):
        picture.line([(30, y), (90, y)], BLUE, 2, arrow=True)
    picture.text((60, 74), "wind", BLUE)
    for center, feather, words in ((260, 0, "pitch 0°"), (500, 40, "pitch positive")):
        middle = 150
        # x to the right, y up: the leading edge points to -y and turns to -x, upwind, as pitch grows.
        edge = (-sin(radians(feather)), -cos(radians(feather)))
        across = (-edge[1], edge[0])
        outline = []
        for along, thick in (
            (1, 0),
            (0.98, 0.06),
            (0.9, 0.12),
            (0.7, 0.17),
            (0.4, 0.17),
            (-0.4, 0.09),
            (-1.4, 0),
            (-0.4, -0.05),
            (0.4, -0.1),
            (0.7, -0.11),
            (0.9, -0.09),
            (0.98, -0.05),
        ):
            x, y = (along * edge[i] * 68 + thick * across[i] * 68 for i in (0, 1))
            outline.append((center + x, middle - y))
        picture.line(outline, width=1.5, fill="#dfe7ed", closed=True)
        picture.line([(center, 62), (center, 250)], PALE, 1, "4 4")
        picture.text((center, 278), words, bold=True)
        tip = (center + edge[0] * 68, middle - edge[1] * 68)
        picture.text((tip[0] + 16, tip[1] + 16), "leading edge", anchor="start", size=13)
        if feather:
            turn = [
                (center - 92 * sin(radians(a)), middle + 92 * cos(radians(a)))
                for a in range(2, feather - 1, 3)
            ]
            picture.line(turn, RED, 2, arrow=True)
            picture.text((center - 62, middle + 92), "β", RED, size=18)
    picture.line([(610, 100), (610, 190)], GREEN, 2, arrow=True)
    picture.text((620, 140), "blade moves", GREEN, "start", 13)
    picture.text((620, 158), "(to −y)", GREEN, "start", 13)
    picture.text((270, 76), "rotor plane", anchor="start", size=13)
    return picture


def sense():
    picture = Picture(720, 520, "The sense of a helix, looking downwind")
    for center, sign, name, sum_of in (
        ((185, 190), 1, "ccw", "rotor + excitation"),
        ((535, 190), -1, "cw", "rotor − excitation"),
    ):
        radius = 100
        picture.text((center[0], 30), f"{name}, looking downwind", bold=True, size=17)
        picture.circle(center, radius, fill=WATER)
        picture.circle(center, 64, PALE, 1.5, dashes="4 4")
        places = [azimuth_of_most(*helix(angle, sign)) for angle in (0, 90, 180, 270)]
        for angle, place in zip((0, 90, 180, 270), places):
            picture.circle(on(center, place, 64), 7, RED, fill=RED)
            x, y = on(center, place, 38)
            picture.text((x, y + 5), f"{angle}°", RED, size=13)
        for first in places:
            # From one place to the next: against azimuth for ccw, with it for cw.
            picture.arc(center, 82, first - 22 * sign, first - 66 * sign, RED)
        picture.arc(center, radius + 14, 20, 70, BLUE)
        x, y = on(center, 45, radius + 24)
        picture.text((x, y), "rotor", BLUE, "start")
        picture.text((center[0], 328), f"blades pitch at {sum_of} frequency", size=14)
        # Commands over one period.
        left, middle, width, height = center[0] - 130, 430, 260, 40
        picture.line([(left, middle), (left + width + 10, middle)], INK, 1, arrow=True)
        picture.line([(left, middle + height + 12), (left, middle - height - 14)], INK, 1, arrow=True)
        for part, color, words in ((0, RED, "tilt"), (1, BLUE, "yaw")):
            curve = [
                (left + width * a / 360, middle - height * helix(a, sign)[part]) for a in range(0, 361, 5)
            ]
            picture.line(curve, color, 2)
            peak = 90 if part == 0 else (0 if sign > 0 else 180)
            picture.text(
                (left + width * peak / 360 + (24 if peak == 0 else 0), middle - height - 8), words, color
            )
        for angle in (90, 180, 270, 360):
            x = left + width * angle / 360
            picture.line([(x, middle - 3), (x, middle + 3)], INK, 1)
            picture.text((x, middle + 66), f"{angle}°", size=12)
        picture.text((left, middle + 66), "0°", size=12)
    picture.text(
        (360, 515),
        "red dots: where pitch is greatest, and thrust least, at four angles ωt + φ of the period",
        size=13,
    )
    return picture


def helix_phase():
    picture = Picture(720, 520, "Phase of the wind and phase offset of the pitch")
    left, width, phase = 110, 540, 60

    def axes(middle, height, words):
        picture.line([(left - 50, middle), (left + width + 16, middle)], INK, 1, arrow=True)
        picture.line([(left, middle + height + 8), (left, middle - height - 16)], INK, 1, arrow=True)
        picture.text((20, middle - height - 24), words, anchor="start", bold=True)
        picture.text((left + width + 26, middle + 18), "ωt", anchor="end")
        for angle in (180, 360, 540):
            x = left + width * angle / 600
            picture.line([(x, middle - 3), (x, middle + 3)], INK, 1)
            picture.text((x, middle + 18), f"{angle}°", size=12)

    def curve(middle, height, lead, color, dashes=None, size=1.0):
        angles = range(-55, 596, 5)
        points = [(left + width * a / 600, middle - size * height * sin(radians(a + lead))) for a in angles]
        picture.line(points, color, 2.5, dashes)

    def peak(lead):
        return left + width * (((90 - lead) % 360)) / 600

    middle, height = 120, 55
    axes(middle, height, "wind that meets the rotor, ccw")
    curve(middle, height, phase, RED)
    curve(middle, height, phase + 90, BLUE)
    picture.text((peak(phase) + 20, middle - height - 6), "tilt", RED)
    picture.text((peak(phase + 90) + 0, middle - height - 6), "yaw", BLUE)
    start = left - width * phase / 600
    picture.line([(start, middle), (start, middle + 40)], RED, 1)
    picture.line([(left, middle + 40), (start + 4, middle + 40)], RED, 1.5, arrow=True)
    picture.text(((start + left) / 2, middle + 58), "φ", RED, size=18)
    picture.text(
        (left + 20, middle + 88),
        "tilt = A sin(ωt + φ),  yaw = A sin(ωt + 90° + φ)  (cw: − 90°)",
        anchor="start",
    )
    middle, height = 350, 70
    axes(middle, height, "pitch, its tilt component, with offset 0°, 90° and 180°")
    curve(middle, height, phase, PALE, "7 5", 0.75)
    for offset, color in ((0, INK), (90, GREEN), (180, "#8e44ad")):
        curve(middle, height, phase + offset, color)
        picture.text((peak(phase + offset), middle - height - 6), f"{offset}°", color)
    picture.text(
        (left + 20, middle + 110),
        "tilt pitch = A sin(ωt + φ + offset); yaw pitch likewise with its own phase",
        anchor="start",
    )
    picture.text(
        (left + 20, middle + 136),
        "0°: pitch rises with the wind (dashed) and takes load off; 180°: it falls there and adds load",
        anchor="start",
        size=13,
    )
    picture.text(
        (left + 20, middle + 156),
        "a positive offset leads: the pitch peaks earlier",
        anchor="start",
        size=13,
    )
    return picture


PICTURES = {
    "frames": frames,
    "azimuth": azimuth,
    "pitch": pitch,
    "sense": sense,
    "helix-phase": helix_phase,
}


def main():
    folder, stale = Path(__file__).parent, []
    for name, draw in PICTURES.items():
        path, svg = folder / f"{name}.svg", draw().svg()
        if sys.argv[1:] == ["--check"]:
            stale += [] if path.exists() and path.read_text(encoding="utf-8") == svg else [path.name]
        else:
            path.write_text(svg, encoding="utf-8")
    if stale:
        sys.exit(f"{', '.join(stale)}: not as docs/pictures/draw.py draws it; run it")


main()
