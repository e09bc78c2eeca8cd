"""Draws the owl: python3 owl.py > owl.svg

Feathers are written one by one as groups with a pivot at the quill, in the convention of `pendulum_runtime::drawing`: the shape
`NAME.keyed` or `NAME.pendulum` in the group NAME is its pivot. Pixels, y down.
"""

from math import cos, sin, radians, pi

DARK = "#2e1c10"


def point(origin, angle, along, across=0.0):
    """A point along a direction (0 to the right, 90 down) and to its left."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return origin[0] + along * c + across * s, origin[1] + along * s - across * c


def text(*points):
    return " ".join(f"{x:.1f} {y:.1f}" for x, y in points)


def mix(a, b, share):
    """A colour between two."""
    parts = [(int(a[i : i + 2], 16), int(b[i : i + 2], 16)) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(p + (q - p) * share):02x}" for p, q in parts)


def pivot(name, kind, at):
    return f'<circle id="{name}.{kind}" cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="1" fill="none"/>'


def feather(name, at, angle, length, width, colour, bars=3, lean=0.0):
    """A vane with bars and a shaft; `lean` makes the left side wider."""
    left, right = width * (0.5 + lean), width * (0.5 - lean)
    at = (round(at[0], 1), round(at[1], 1))
    p = lambda along, across: point(at, angle, along * length, across)
    vane = (
        f"M{text(at)}C{text(p(0.12, left), p(0.55, 1.25 * left), p(0.86, 0.72 * left))}"
        f"Q{text(p(0.97, 0.38 * left), p(1.0, 0.0))}Q{text(p(0.97, -0.38 * right), p(0.86, -0.72 * right))}"
        f"C{text(p(0.55, -1.25 * right), p(0.12, -right), at)}Z"
    )
    lines = ""
    for bar in range(bars):
        x = 0.42 + 0.5 * bar / max(bars, 1)
        lines += f"M{text(p(x - 0.05, 0.82 * left))}Q{text(p(x + 0.05, 0.0), p(x - 0.05, -0.82 * right))}"
    if lines:
        lines = f'<path d="{lines}" fill="none" stroke="{DARK}" stroke-opacity=".38" stroke-width="{0.13 * width + 1.2:.1f}"/>'
    shaft = f'<path d="M{text(at)}L{text(p(0.93, 0.0))}" fill="none" stroke="#f3dcb4" stroke-opacity=".55" stroke-width="1.3"/>'
    return (
        f'<g id="{name}">{pivot(name, "pendulum", at)}'
        f'<path d="{vane}" fill="{colour}" stroke="{DARK}" stroke-width="1.1"/>{lines}{shaft}</g>\n'
    )


def wing(side):
    """The wing on the owl's left (+1) or right (-1) of the picture: coverts over secondaries, a hand with primaries."""
    who = "left" if side < 0 else "right"
    turn = lambda angle: angle if side > 0 else 180.0 - angle
    at = lambda x, y: (300 + side * x, y)
    shoulder, wrist, tip = at(82, 318), at(196, 262), at(262, 258)
    between = lambda a, b, share: (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
    out = f'<g id="wing-{who}">{pivot(f"wing-{who}", "keyed", shoulder)}\n'
    # The hand lies behind the arm.
    out += f'<g id="hand-{who}">{pivot(f"hand-{who}", "keyed", wrist)}\n'
    for k in range(9):
        share = k / 8
        colour = mix("#7a4e2d", "#5d3820", share) if k % 2 else mix("#8a5a35", "#6a4226", share)
        length = 148 + 46 * sin(pi * (0.12 + 0.62 * share))
        base = between(wrist, tip, share)
        out += feather(f"primary-{who}-{k + 1}", base, turn(82 - 84 * share), length, 35, colour, 4, -0.12 * side)
    out += bone(wrist, tip, 11, "#8b5e3a")
    for k in range(6):
        base = between(wrist, tip, 0.04 + 0.92 * k / 5)
        out += feather(f"covert-{who}-{k + 7}", base, turn(84 - 76 * k / 5), 64 + 4 * k, 26, mix("#a97646", "#8f6038", k / 5), 2)
    out += "</g>\n"
    for k in range(8):
        share = k / 7
        base = between(shoulder, wrist, share)
        colour = mix("#9a6a40", "#80522f", share) if k % 2 else mix("#a97848", "#8a5a35", share)
        out += feather(f"secondary-{who}-{k + 1}", base, turn(101 - 17 * share), 118 + 26 * share, 35, colour, 4, -0.08 * side)
    out += bone(shoulder, wrist, 15, "#9a6c43")
    for k in range(6):
        base = between(shoulder, wrist, 0.02 + 0.97 * k / 5)
        out += feather(f"covert-{who}-{k + 1}", base, turn(104 - 17 * k / 5), 66, 31, mix("#c08f58", "#b07d4b", k / 5), 2)
    return out + "</g>\n"


def bone(a, b, width, colour):
    """The skin over the bones, round at both ends."""
    length = ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5
    nx, ny = (b[1] - a[1]) / length * width, -(b[0] - a[0]) / length * width
    corners = [(a[0] + nx, a[1] + ny), (b[0] + 0.6 * nx, b[1] + 0.6 * ny), (b[0] - 0.6 * nx, b[1] - 0.6 * ny), (a[0] - nx, a[1] - ny)]
    return (
        f'<path d="M{text(corners[0])}L{text(corners[1])}A{0.6 * width:.1f} {0.6 * width:.1f} 0 0 1 {text(corners[2])}'
        f'L{text(corners[3])}A{width} {width} 0 0 1 {text(corners[0])}Z" fill="{colour}"/>\n'
    )


def tail():
    out = f'<g id="tail">{pivot("tail", "keyed", (300, 505))}\n'
    order = sorted(range(9), key=lambda k: -abs(k - 4))
    for k in order:
        angle = 90 - 7.5 * (k - 4)
        base = (300 + 7 * (k - 4), 515 - 1.2 * abs(k - 4))
        out += feather(f"tail-{k + 1}", base, angle, 138 - 3.5 * abs(k - 4), 33, "#7b5030" if k % 2 else "#8c5d38", 4)
    return out + "</g>\n"


def body():
    out = '<path d="M300 268C372 268 402 330 402 402C402 482 362 540 300 540C238 540 198 482 198 402C198 330 228 268 300 268Z" fill="url(#coat)" stroke="#2e1c10" stroke-width="1.5"/>\n'
    out += '<path d="M300 300C348 300 368 350 368 408C368 470 340 522 300 522C260 522 232 470 232 408C232 350 252 300 300 300Z" fill="#e2c08c" fill-opacity=".9"/>\n'
    # Rows from below, each over the one beneath it.
    number = 0
    for row, (y, count, half) in enumerate([(462, 4, 46), (430, 5, 57), (398, 6, 62), (366, 5, 56), (336, 4, 42)]):
        for k in range(count):
            number += 1
            x = 300 + half * (2 * k / (count - 1) - 1)
            angle = 90 - 9 * (2 * k / (count - 1) - 1)
            colour = mix("#edd3a4", "#d8b078", (row + k) % 3 / 2)
            out += feather(f"breast-{number}", (x, y), angle, 55, 34, colour, 1)
    return out


def feet():
    """Three toes a foot, seen from the front."""
    out = ""
    for side in (-1, 1):
        x = 300 + 36 * side
        out += f'<path d="M{x - 17} 520C{x - 17} 545 {x + 17} 545 {x + 17} 520Z" fill="#c99d66"/>\n'
        for toe in (-1, 0, 1):
            t = x + 13 * toe
            out += f'<path d="M{t - 6} 540C{t - 7} 556 {t - 4} 566 {t} 568C{t + 4} 566 {t + 7} 556 {t + 6} 540Z" fill="#d9a441" stroke="{DARK}" stroke-width="1"/>\n'
            out += f'<path d="M{t - 3} 561L{t} 574L{t + 3} 561Z" fill="{DARK}"/>\n'
    return out


def head():
    out = f'<g id="head">{pivot("head", "keyed", (300, 290))}\n'
    # A ruff that hides the neck; the outermost first.
    for k, side in ((k, side) for k in range(4) for side in (-1, 1)):
        angle = 90 - side * (50 - 14 * k)
        base = (300 + side * (74 - 17 * k), 250 + 6 * k)
        who = "left" if side < 0 else "right"
        out += feather(f"ruff-{who}-{k + 1}", base, angle, 54, 32, mix("#b98752", "#d3a970", k / 3), 1)
    for side in (-1, 1):
        who = "left" if side < 0 else "right"
        at = (300 + side * 62, 150)
        out += f'<g id="ear-{who}">{pivot(f"ear-{who}", "keyed", at)}\n'
        for k, (lean, length, colour) in enumerate([(34, 50, "#6d4527"), (8, 58, "#7d5130"), (21, 66, "#8f5f39")]):
            out += feather(f"tuft-{who}-{k + 1}", (at[0] + side * 0.32 * (lean - 20), at[1] + 2), -90 + side * lean, length, 21, colour, 2)
        out += "</g>\n"
    out += '<path d="M300 124C352 120 396 150 396 200C396 248 352 282 300 282C248 282 204 248 204 200C204 150 248 120 300 124Z" fill="url(#crown)" stroke="#2e1c10" stroke-width="1.5"/>\n'
    for side in (-1, 1):
        x = 300 + side * 43
        out += f'<circle cx="{x}" cy="205" r="53" fill="#ecd2a2" stroke="#8d6239" stroke-width="3"/>\n'
        for k in range(16):
            a, b = point((x, 205), 22.5 * k + 6, 33), point((x, 205), 22.5 * k + 6, 49)
            out += f'<path d="M{text(a)}L{text(b)}" fill="none" stroke="#b98c58" stroke-width="1.6"/>'
        out += f'\n<circle cx="{x}" cy="203" r="30" fill="{DARK}"/><circle cx="{x}" cy="203" r="26" fill="url(#iris)"/>'
        out += f'<circle cx="{x}" cy="203" r="14" fill="#120b06"/><circle cx="{x - 6}" cy="195" r="5" fill="#fff"/>\n'
        out += f'<path d="M{300 + side * 4} 180C{300 + side * 22} 160 {300 + side * 58} 142 {300 + side * 84} 140C{300 + side * 70} 158 {300 + side * 40} 172 {300 + side * 12} 190Z" fill="#f3e2c0" stroke="#6d4527" stroke-width="1.2"/>\n'
    out += '<path d="M300 208C314 214 316 230 300 252C284 230 286 214 300 208Z" fill="#4a3a2c" stroke="#1c130c" stroke-width="1.2"/>'
    out += '<path d="M300 213C304 220 304 232 300 244" fill="none" stroke="#8d7760" stroke-width="2"/>\n'
    return out + "</g>\n"


def scenery():
    out = '<rect id="sky" x="-170" y="-30" width="940" height="750" fill="url(#night)"/>\n<circle id="moon" cx="596" cy="106" r="56" fill="#f4ecd0"/>'
    out += '<circle cx="580" cy="94" r="9" fill="#dfd5b4"/><circle cx="612" cy="122" r="13" fill="#dfd5b4"/><circle cx="610" cy="86" r="6" fill="#dfd5b4"/>\n'
    state = 7
    for _ in range(90):
        state = state * 1103515245 + 12345 & 0x7FFFFFFF
        x, y = state % 940 - 170, state // 940 % 500 - 30
        if (x - 596) ** 2 + (y - 106) ** 2 < 75**2:
            continue
        out += f'<circle cx="{x}" cy="{y}" r="{0.8 + state // 7 % 10 / 9:.1f}" fill="#fff" fill-opacity="{0.35 + state // 11 % 6 / 10:.2f}"/>'
    out += '\n<path id="branch" d="M-180 602C20 560 190 572 300 566C440 558 600 590 780 552L780 584C620 618 440 588 300 594C180 600 40 596 -180 634Z" fill="#3a281b" stroke="#1c130c" stroke-width="1.5"/>\n'
    out += '<path d="M-150 614C40 580 180 590 330 581M390 583C500 580 620 602 750 570" fill="none" stroke="#5a402b" stroke-width="3"/>\n'
    return out


def main():
    print(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="-170 -30 940 750" width="940" height="750" stroke-linejoin="round" stroke-linecap="round">\n'
        "<title>Owl</title>\n<defs>"
        '<linearGradient id="night" x1="0" y1="0" x2="0" y2="1"><stop offset="0" stop-color="#131a33"/><stop offset="1" stop-color="#46547c"/></linearGradient>'
        '<linearGradient id="coat" x1="0" y1="0" x2="0" y2="1"><stop offset="0" stop-color="#a97646"/><stop offset="1" stop-color="#7a4e2d"/></linearGradient>'
        '<linearGradient id="crown" x1="0" y1="0" x2="0" y2="1"><stop offset="0" stop-color="#8a5a35"/><stop offset="1" stop-color="#b98752"/></linearGradient>'
        '<radialGradient id="iris"><stop offset=".45" stop-color="#ffc23d"/><stop offset="1" stop-color="#e2801b"/></radialGradient></defs>'
    )
    print(scenery(), end="")
    print(f'<g id="owl">{pivot("owl", "keyed", (300, 566))}\n' + tail() + wing(-1) + wing(1) + feet() + body() + head() + "</g>\n</svg>")


main()
