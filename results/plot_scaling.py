#!/usr/bin/env python3
"""Build time against triangle count, from a run of scaling.toml: writes scaling.csv and scaling.svg.

    results/plot_scaling.py results/scaling
"""
import csv
import json
import math
import pathlib
import sys

WIDTH, HEIGHT, MARGIN = 720, 460, 70
COLORS = ["#1b6ca8", "#d1495b", "#2e933c", "#edae49", "#66438c", "#30638e", "#7a7a7a"]


def read(folder):
    """{(method, variant): [(triangles, milliseconds)]}, each list by triangle count."""
    results = json.loads((folder / "summary.json").read_text())["results"]
    triangles = {r["scene"]: r["metrics"]["triangles"]["median"]
                 for r in results if "triangles" in r["metrics"]}
    lines = {}
    for r in results:
        if "build_ms" in r["metrics"]:
            point = (triangles[r["scene"]], r["metrics"]["build_ms"]["median"])
            lines.setdefault((r["method"], r["variant"]), []).append(point)
    return {key: sorted(points) for key, points in sorted(lines.items())}


def write_csv(path, lines):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["method", "variant", "triangles", "build_ms"])
        for (method, variant), points in lines.items():
            writer.writerows([method, variant, int(t), f"{ms:.3f}"] for t, ms in points)


def write_svg(path, lines):
    points = [point for line in lines.values() for point in line]
    low = [math.floor(math.log10(min(p[i] for p in points))) for i in (0, 1)]
    high = [math.ceil(math.log10(max(p[i] for p in points))) for i in (0, 1)]
    size = (WIDTH - 2 * MARGIN - 120, HEIGHT - 2 * MARGIN)

    def place(point):
        x, y = [(math.log10(point[i]) - low[i]) / (high[i] - low[i]) * size[i] for i in (0, 1)]
        return MARGIN + x, HEIGHT - MARGIN - y

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif" font-size="13"><rect width="100%" height="100%" fill="#fff"/>']
    for axis in (0, 1):
        for power in range(low[axis], high[axis] + 1):
            a, b = [10 ** low[0], 10 ** low[1]], [10 ** high[0], 10 ** high[1]]
            a[axis] = b[axis] = 10 ** power
            (x0, y0), (x1, y1) = place(a), place(b)
            out.append(f'<path d="M{x0:.1f} {y0:.1f}L{x1:.1f} {y1:.1f}" stroke="#ddd"/>')
            x, y, anchor = (x0, y0 + 18, "middle") if axis == 0 else (x0 - 8, y0 + 4, "end")
            label = f"{10 ** power:g}"
            out.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{label}</text>')
    for i, ((method, variant), line) in enumerate(lines.items()):
        color = COLORS[i % len(COLORS)]
        path_data = "L".join("{:.1f} {:.1f}".format(*place(p)) for p in line)
        out.append(f'<path d="M{path_data}" fill="none" stroke="{color}" stroke-width="2"/>')
        out += ['<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>'.format(*place(p), color)
                for p in line]
        name = method if variant == "default" else f"{method}, {variant}"
        out.append(f'<text x="{WIDTH - MARGIN - 105}" y="{MARGIN + 18 * i}" fill="{color}">{name}</text>')
    out.append(f'<text x="{MARGIN + size[0] / 2}" y="{HEIGHT - 22}" text-anchor="middle">triangles</text>')
    out.append(f'<text x="20" y="{MARGIN - 20}">build time in ms (medians)</text></svg>\n')
    path.write_text("\n".join(out))


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[1])
    write_csv(target / "scaling.csv", read(target))
    write_svg(target / "scaling.svg", read(target))
