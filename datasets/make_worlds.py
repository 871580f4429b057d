#!/usr/bin/env python3
"""Draws the worlds of this directory. Python 3 standard library only; the same program writes the same bytes.

Not part of the build: run it only to change a world, look at the result (--png DIR), and commit the new .txt.
"""

import argparse
import math
import pathlib
import random
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent


class Canvas:
    """A map with metric drawing; y grows upwards, everything is rounded to whole cells."""

    def __init__(self, width, height, resolution, solid=False):
        self.resolution = resolution
        self.width = round(width / resolution)
        self.height = round(height / resolution)
        self.cells = [[solid] * self.width for _ in range(self.height)]

    def fill(self, x0, y0, x1, y1, solid=True):
        to_cell = lambda v: round(v / self.resolution)
        for y in range(max(0, to_cell(y0)), min(self.height, to_cell(y1))):
            for x in range(max(0, to_cell(x0)), min(self.width, to_cell(x1))):
                self.cells[y][x] = solid

    def clear(self, x0, y0, x1, y1):
        self.fill(x0, y0, x1, y1, solid=False)

    def frame(self, x0, y0, x1, y1, wall):
        """Walls around a rectangle, on its inner side."""
        self.fill(x0, y0, x1, y0 + wall)
        self.fill(x0, y1 - wall, x1, y1)
        self.fill(x0, y0, x0 + wall, y1)
        self.fill(x1 - wall, y0, x1, y1)

    def disc(self, x, y, radius):
        for row in range(self.height):
            for column in range(self.width):
                cx, cy = (column + 0.5) * self.resolution, (row + 0.5) * self.resolution
                if math.hypot(cx - x, cy - y) <= radius:
                    self.cells[row][column] = True

    def close_pockets(self):
        """Makes solid what is not joined to the largest free region (4 neighbours)."""
        region = [[0] * self.width for _ in range(self.height)]
        sizes = [0]
        for y in range(self.height):
            for x in range(self.width):
                if self.cells[y][x] or region[y][x]:
                    continue
                sizes.append(0)
                stack = [(x, y)]
                region[y][x] = len(sizes) - 1
                while stack:
                    cx, cy = stack.pop()
                    sizes[-1] += 1
                    for nx, ny in ((cx + 1, cy), (cx - 1, cy), (cx, cy + 1), (cx, cy - 1)):
                        if not (0 <= nx < self.width and 0 <= ny < self.height):
                            continue
                        if not self.cells[ny][nx] and not region[ny][nx]:
                            region[ny][nx] = len(sizes) - 1
                            stack.append((nx, ny))
        largest = sizes.index(max(sizes))
        for y in range(self.height):
            for x in range(self.width):
                self.cells[y][x] = region[y][x] != largest

    def rows(self):
        return ["".join("#" if solid else "." for solid in row) for row in reversed(self.cells)]


class World:
    def __init__(self, name, provenance, canvas, starts, robots):
        self.name, self.provenance, self.canvas, self.starts, self.robots = name, provenance, canvas, starts, robots

    def text(self):
        lines = [f"provenance: {self.provenance}", f"resolution: {self.canvas.resolution:g}"]
        lines += [f"start: {x:g} {y:g} {theta:.6g}" for x, y, theta in self.starts]
        lines += [f"robot: {robot}" for robot in self.robots]
        return "\n".join(lines + ["map:"] + self.canvas.rows()) + "\n"

    def png(self, path, scale):
        """A picture with the starts, to look at."""
        c = self.canvas
        pixels = [[(60, 60, 60) if solid else (245, 245, 245) for solid in row for _ in range(scale)]
                  for row in reversed(c.cells) for _ in range(scale)]
        for i, (x, y, _) in enumerate(self.starts):
            px, py = int(x / c.resolution * scale), int((c.height - y / c.resolution) * scale)
            reach = max(2, round(0.2 / c.resolution * scale))
            for dy in range(-reach, reach + 1):
                for dx in range(-reach, reach + 1):
                    if dx * dx + dy * dy <= reach * reach:
                        pixels[py + dy][px + dx] = (200, 30, 30) if i < len(self.robots) else (40, 90, 200)
        raw = b"".join(b"\0" + b"".join(bytes(p) for p in row) for row in pixels)
        chunk = lambda tag, data: struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
        header = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 2, 0, 0, 0)
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) +
                         chunk(b"IEND", b""))


def block_of_starts(x, y, columns, rows, pitch, theta=0.0):
    return [(round(x + i * pitch, 6), round(y + j * pitch, 6), theta) for j in range(rows) for i in range(columns)]


def robots(count, speed, sensing_range, radius):
    return [f"name=r{i + 1} speed={speed:g} range={sensing_range:g} radius={radius:g}" for i in range(count)]


# Start cells of Dai et al. 2014, tables 2 and 3: none of them may be in an obstacle, nor boxed in.
DAI_RANDOM = """
88,74 14,1 89,20 30,66  61,2 2,19 59,6 37,63  27,25 87,23 80,91 23,24  72,51 78,49 19,70 98,81
5,57 70,96 75,74 43,63  68,5 36,50 43,56 62,11  33,48 60,16 83,96 60,3  95,64 25,35 19,49 41,46
72,57 46,45 9,44 37,30  97,36 5,76 89,29 25,93  41,82 87,2 73,85 73,96  84,18 51,45 33,38 89,76
10,64 44,7 37,25 93,63  82,13 88,51 96,12 5,38  95,26 51,64 40,49 75,13  84,88 70,76 97,40 13,72
56,70 29,99 22,50 43,52  1,66 72,28 26,71 78,99  13,94 70,85 21,46 8,85  5,1 76,60 95,82 56,98
"""
DAI_TOGETHER = """
95,23 46,51 92,74 41,89 20,60 45,93 20,67 83,50 19,68 38,86 82,64 34,53 37,40 79,96 27,25 30,66 58,42 58,76 78,68 60,5
"""


def cells_of(table):
    return [tuple(int(v) for v in pair.split(",")) for pair in table.split()]


def field():
    rng = random.Random(2014)
    canvas = Canvas(100, 100, 1.0)
    keep = {(x + dx, y + dy) for x, y in cells_of(DAI_RANDOM) + cells_of(DAI_TOGETHER)
            for dx in (-1, 0, 1) for dy in (-1, 0, 1)}
    solid = set()
    while len(solid) < 1000:
        x, y = rng.randrange(100), rng.randrange(100)
        for _ in range(rng.randrange(1, 9)):
            if (x, y) not in keep and 0 <= x < 100 and 0 <= y < 100:
                solid.add((x, y))
            dx, dy = rng.choice(((1, 0), (-1, 0), (0, 1), (0, -1)))
            x, y = x + dx, y + dy
    for x, y in solid:
        canvas.cells[y][x] = True
    canvas.close_pockets()
    random_rows = cells_of(DAI_RANDOM)
    cells = random_rows[36:40] + random_rows[0:12]  # No. 10, then Nos. 1 to 3
    team = [f"name=R{i + 1} speed={v} range={r} radius=0.45" for i, (v, r) in enumerate(((3, 4), (4, 8), (3, 3), (2, 4)))]
    return World("field", "made for this project after Dai et al. 2014: 100 x 100 cells, a tenth of them obstacles in "
                 "clumps; starts of table 2, No. 10 first (a cell's number is its index)", canvas,
                 [(x + 0.5, y + 0.5, 0.0) for x, y in cells], team)


def office1():
    c = Canvas(26, 16, 0.25)
    c.frame(0, 0, 26, 16, 0.25)
    c.fill(0, 6.5, 26, 6.75)
    c.fill(0, 9.25, 26, 9.5)
    walls_above, walls_below = (0, 5.5, 10, 15.5, 20.75, 25.75), (0, 4.75, 10.5, 15, 21, 25.75)
    for x in walls_above[1:-1]:
        c.fill(x, 9.25, x + 0.25, 16)
    for x in walls_below[1:-1]:
        c.fill(x, 0, x + 0.25, 6.75)
    for x in (2, 8.25, 11, 18, 22.5):
        c.clear(x, 9.25, x + 1.25, 9.5)
    for x in (3, 6, 12, 19, 22):
        c.clear(x, 6.5, x + 1.25, 6.75)
    for x0, y0, x1, y1 in ((1.25, 13.5, 3.25, 14.5), (7, 12, 8, 14.5), (12, 12, 14, 13.25), (17, 14.75, 20, 15.75),
                           (23, 12.5, 24.25, 13.75), (1, 1.5, 2, 4), (6.5, 2, 8.75, 3), (12.25, 1.5, 13.25, 2.5),
                           (16.5, 2.5, 19, 3.5), (23.25, 0.25, 25.75, 1.25)):
        c.fill(x0, y0, x1, y1)
    starts = block_of_starts(0.875, 7.375, 8, 2, 1.25)
    order = [0, 8, 1, 9]
    starts = [starts[i] for i in order] + [s for i, s in enumerate(starts) if i not in order]
    return World("office1", "made for this project after the first dense office of Matignon et al. 2012 (fig. 4a): one "
                 "corridor, ten rooms, four robots", c, starts, robots(4, 0.5, 4, 0.2))


def office2():
    c = Canvas(30, 20, 0.25)
    c.frame(0, 0, 30, 20, 0.25)
    # Two corridors, three passages between them: two loops round two blocks of three rooms.
    for y in (5.25, 7.25, 12.5, 14.5):
        c.fill(0, y, 30, y + 0.25)
    for x0, x1 in ((0.25, 2), (13.75, 16), (28, 29.75)):
        c.clear(x0, 7.25, x1, 12.75)
    for x in (2, 13.5, 16, 27.75):
        c.fill(x, 7.25, x + 0.25, 12.75)
    for x in (6, 9.75, 20, 23.75):
        c.fill(x, 7.25, x + 0.25, 12.75)
    for x in (6, 12, 17.75, 23.5):
        c.fill(x, 0, x + 0.25, 5.5)
    for x in (5.5, 11.5, 18, 24.25):
        c.fill(x, 14.5, x + 0.25, 20)
    for x in (2.5, 8.25, 14, 20, 26):
        c.clear(x, 5.25, x + 1.25, 5.5)
    for x in (3.5, 7, 15, 21, 25.25):
        c.clear(x, 14.5, x + 1.25, 14.75)
    for x, y in ((3.5, 7.25), (7.25, 12.5), (11, 7.25), (17.25, 12.5), (21.25, 7.25), (25.25, 12.5)):
        c.clear(x, y, x + 1.25, y + 0.25)
    for x0, y0, x1, y1 in ((1.5, 1.5, 3.5, 2.5), (8, 1.25, 10, 2.25), (14, 2, 16, 3), (19.75, 1, 20.75, 3.5),
                           (26, 0.25, 28.5, 1.25), (2, 17.25, 3.25, 18.5), (8, 17, 9.5, 18), (13.5, 18.5, 16.5, 19.75),
                           (20, 17, 22.25, 18), (26.5, 17.5, 27.75, 18.75), (11.25, 10.5, 12.25, 12), (18, 9, 19, 10)):
        c.fill(x0, y0, x1, y1)
    starts = block_of_starts(14.375, 8.375, 2, 3, 1.25, math.pi / 2)
    starts = [starts[0], starts[1], starts[2], starts[3], starts[4], starts[5]]
    starts += block_of_starts(10.625, 6.375, 3, 1, 1.25) + block_of_starts(16.875, 6.375, 3, 1, 1.25)
    starts += block_of_starts(11.875, 13.625, 2, 1, 1.25) + block_of_starts(16.875, 13.625, 2, 1, 1.25)
    return World("office2", "made for this project after the second dense office of Matignon et al. 2012 (fig. 4b): two "
                 "corridors and three passages around sixteen rooms, three robots", c, starts, robots(3, 0.5, 4, 0.2))


def urban():
    c = Canvas(32, 26, 0.2)
    c.frame(0, 0, 32, 26, 0.2)
    blocks = ((2.4, 2.4, 8.4, 7.6), (10.8, 2.4, 15.2, 5.0), (10.8, 6.6, 15.2, 9.6), (18.0, 2.4, 24.0, 7.0),
              (26.2, 2.4, 29.6, 9.6), (2.4, 10.0, 5.0, 16.0), (6.8, 10.0, 9.0, 16.0), (11.4, 12.2, 16.0, 16.4),
              (18.4, 9.4, 23.8, 12.0), (18.4, 13.8, 20.6, 18.0), (22.2, 13.8, 24.0, 18.0), (26.2, 12.0, 29.6, 18.0),
              (2.4, 18.6, 9.0, 20.6), (2.4, 22.2, 9.0, 23.6), (11.4, 19.0, 13.2, 23.6), (15.0, 21.0, 23.0, 23.6),
              (25.4, 20.6, 29.6, 23.6))
    for block in blocks:
        c.fill(*block)
    c.clear(4.4, 4.2, 6.4, 7.6)      # a yard
    c.clear(27.4, 13.8, 29.6, 16.0)  # another, from the east
    c.clear(18.0, 4.0, 20.0, 5.6)    # a gateway that leads nowhere
    for x, y in ((16.6, 10.6), (17.2, 19.4), (1.2, 9.0), (25.0, 11.0), (10.0, 17.4), (30.8, 10.8)):
        c.disc(x, y, 0.3)            # trees and posts
    starts = block_of_starts(0.7, 0.7, 8, 2, 0.9)
    order = [0, 1, 8]
    starts = [starts[i] for i in order] + [s for i, s in enumerate(starts) if i not in order]
    return World("urban", "made for this project after the urban map of Lozenguez et al. 2015 (figs. 3 and 8a), "
                 "32 x 26 m: streets between blocks, yards, three robots", c, starts, robots(3, 1, 5, 0.25))


def labyrinth():
    """A spanning tree of passages, 16 x 13 squares of 2 m, then some walls opened to make loops."""
    rng = random.Random(2015)
    columns, lines, pitch, wall = 16, 13, 2.0, 0.2
    c = Canvas(32, 26, 0.2, solid=True)

    def open_between(a, b):
        (ax, ay), (bx, by) = sorted((a, b))
        c.clear(ax * pitch + wall, ay * pitch + wall, (bx + 1) * pitch - wall, (by + 1) * pitch - wall)

    def neighbours(x, y):
        return [(nx, ny) for nx, ny in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1))
                if 0 <= nx < columns and 0 <= ny < lines]

    seen, joined, stack = {(0, 0)}, set(), [(0, 0)]
    while stack:
        at = stack[-1]
        ahead = [n for n in neighbours(*at) if n not in seen]
        if not ahead:
            stack.pop()
            continue
        nearest = rng.choice(ahead)
        joined.add(tuple(sorted((at, nearest))))
        seen.add(nearest)
        stack.append(nearest)
    closed = [tuple(sorted(((x, y), n))) for x in range(columns) for y in range(lines) for n in neighbours(x, y)
              if n > (x, y) and tuple(sorted(((x, y), n))) not in joined]
    joined.update(rng.sample(closed, 20))
    for a, b in sorted(joined):
        open_between(a, b)
    starts = [(x, y, 0.0) for x in (0.7, 1.3) for y in (0.7, 1.3)]
    corners = [(1, 1), (31, 1), (1, 25), (31, 25), (15, 13), (7, 7), (23, 7), (7, 19), (23, 19), (15, 1), (15, 25),
               (1, 13), (31, 13)]
    starts = starts[:3] + [starts[3]] + [(float(x), float(y), 0.0) for x, y in corners[1:]]
    return World("labyrinth", "made for this project after the labyrinth of Lozenguez et al. 2015 (fig. 8b): 32 x 26 m, "
                 "passages of 1.6 m, some loops, three robots", c, starts, robots(3, 1, 5, 0.2))


class Office:
    """Draws rooms and furniture for the demonstration world."""

    def __init__(self, canvas):
        self.c = canvas

    def wall_h(self, x0, x1, y):
        self.c.fill(x0, y - 0.1, x1, y + 0.1)

    def wall_v(self, x, y0, y1):
        self.c.fill(x - 0.1, y0, x + 0.1, y1)

    def door_h(self, x, y, width=1.0):
        self.c.clear(x, y - 0.1, x + width, y + 0.1)

    def door_v(self, x, y, width=1.0):
        self.c.clear(x - 0.1, y, x + 0.1, y + width)

    def workplace(self, x, y, up):
        """A desk of 1.6 x 0.8 m with a chair; `up`: the chair is above the desk."""
        self.c.fill(x, y, x + 1.6, y + 0.8)
        chair = y + 1.0 if up else y - 0.6
        self.c.fill(x + 0.6, chair, x + 1.0, chair + 0.4)

    def desk_island(self, x, y):
        """Four workplaces back to back, 3.2 x 3.2 m with the chairs."""
        for dx in (0, 1.6):
            self.workplace(x + dx, y + 0.8, False)
            self.workplace(x + dx, y + 1.6, True)

    def table(self, x, y, width, depth):
        """A meeting table with chairs on its long sides."""
        self.c.fill(x, y, x + width, y + depth)
        count = int(width / 0.9)
        for i in range(count):
            cx = x + (i + 0.5) * width / count - 0.2
            self.c.fill(cx, y - 0.6, cx + 0.4, y - 0.2)
            self.c.fill(cx, y + depth + 0.2, cx + 0.4, y + depth + 0.6)


def office():
    c = Canvas(50, 30, 0.1)
    o = Office(c)
    c.frame(0, 0, 50, 30, 0.3)
    # Corridors: y 8..10.2 and y 19.8..22, joined at x 15.8..18 and x 33..35.2; the lobby joins them in the west.
    # South row: offices with a desk at the window and a cabinet at the side.
    south = (0.3, 4.3, 8.3, 13.5, 17.5, 21.5, 28.5, 32.5, 36.5, 42.0, 45.8, 49.7)
    o.wall_h(0, 50, 8.0)
    for x in south[1:-1]:
        o.wall_v(x, 0, 8.0)
    for i, (x0, x1) in enumerate(zip(south, south[1:])):
        o.door_h(x0 + (0.5 if i % 2 else x1 - x0 - 1.6), 8.0, 1.0)
        if x1 - x0 > 6:  # meeting room
            o.table(x0 + 1.4, 3.2, x1 - x0 - 2.8, 1.4)
            c.fill(x0 + 0.1, 0.3, x0 + 0.7, 2.2)
        elif x1 - x0 > 5:  # four desks
            o.desk_island(x0 + 1.0, 2.0)
            c.fill(x1 - 0.6, 0.3, x1 - 0.1, 1.8)
        else:
            o.workplace(x0 + (1.0 if i % 2 else 1.2), 0.9 if i % 3 else 1.3, True)
            o.workplace(x0 + (1.3 if i % 2 else 0.9), 4.6, False)
            c.fill(x1 - 0.6, 1.2, x1 - 0.1, 2.6)
    # North row: offices in the west, an open-plan room in the middle, laboratories in the east.
    o.wall_h(0, 50, 22.0)
    north = (0.3, 5.2, 9.2, 13.2, 17.2, 33.8, 41.8, 49.7)
    for x in north[1:-1]:
        o.wall_v(x, 22.0, 30)
    for x0 in (1.0, 7.6, 9.9, 15.4):
        o.door_h(x0, 22.0, 1.0)
    for x0, y0 in ((1.2, 27.6), (6.2, 27.8), (10.2, 27.6), (14.2, 27.8)):
        o.workplace(x0, y0, False)
        c.fill(x0 - 0.2, 23.9, x0 + 0.3, 25.2)
    for x0 in (18.6, 25.0, 30.6):
        o.door_h(x0, 22.0, 1.4)
    for x in (18.8, 23.2, 27.6):
        o.desk_island(x, 25.6)
    c.fill(32.4, 25.0, 33.7, 29.7)  # shelves
    for x in (22.4, 26.8, 31.4):
        c.fill(x - 0.2, 24.0, x + 0.2, 24.4)  # columns
    o.door_h(35.0, 22.0, 1.2)
    o.door_h(47.6, 22.0, 1.2)
    o.door_v(41.8, 25.4, 1.0)
    for y in (24.2, 26.2, 28.2):
        c.fill(35.6, y, 40.0, y + 0.8)  # benches
    for x in (43.4, 45.6, 47.8):
        c.fill(x, 24.4, x + 0.8, 28.0)
    # Middle, west: the lobby with a reception desk and seats, a kitchen and a meeting room.
    o.wall_v(8.4, 10.2, 19.8)
    o.wall_v(15.7, 10.2, 19.8)
    o.wall_h(8.4, 15.8, 10.3)
    o.wall_h(8.4, 15.8, 15.0)
    o.wall_h(8.4, 15.8, 19.7)
    o.door_v(8.4, 12.0, 1.2)
    o.door_h(13.6, 10.3, 1.0)
    o.door_v(15.7, 16.6, 1.0)
    o.door_h(9.4, 19.7, 1.0)
    c.fill(8.5, 14.3, 14.0, 14.9)   # kitchen unit
    o.table(10.2, 11.9, 2.0, 0.9)
    o.table(10.4, 16.8, 3.6, 1.2)
    c.fill(5.2, 13.4, 5.8, 16.6)    # reception
    c.fill(5.2, 16.0, 7.4, 16.6)
    c.fill(0.3, 11.2, 1.1, 13.6)    # sofas
    c.fill(0.3, 16.4, 1.1, 18.8)
    c.disc(2.2, 12.4, 0.4)
    c.disc(3.2, 18.2, 0.4)
    # Middle: the core. Lifts and shafts are solid; toilets, store, server room, stairs.
    o.wall_v(18.1, 10.2, 19.8)
    o.wall_v(32.9, 10.2, 19.8)
    o.wall_h(18.0, 33.0, 10.3)
    o.wall_h(18.0, 33.0, 19.7)
    o.wall_h(18.0, 33.0, 15.0)
    c.fill(22.4, 10.2, 26.0, 15.0)
    for x in (22.3, 26.1, 29.5):
        o.wall_v(x, 10.2, 15.0)
    for x in (21.7, 25.3, 29.0):
        o.wall_v(x, 15.0, 19.8)
    o.door_v(18.1, 12.4, 1.0)
    o.door_h(27.2, 10.3, 1.0)
    o.door_v(32.9, 12.4, 1.0)
    o.door_v(18.1, 16.8, 1.0)
    o.door_h(23.0, 19.7, 1.0)
    o.door_h(26.6, 19.7, 1.0)
    o.door_v(32.9, 17.0, 1.0)
    for y in (10.4, 11.6, 13.4):
        c.fill(20.6, y, 22.2, y + 0.1)      # cubicles
    c.fill(18.9, 14.4, 22.2, 14.9)
    c.fill(26.2, 14.3, 29.4, 14.9)          # shelves
    for x in (22.6, 24.1):
        c.fill(x, 15.9, x + 0.6, 18.0)      # racks
    c.fill(26.6, 15.1, 27.8, 17.6)          # flight of stairs
    c.fill(30.2, 15.6, 30.8, 18.6)
    c.fill(30.6, 11.2, 31.4, 12.6)
    c.fill(19.2, 15.9, 20.4, 16.6)
    c.fill(19.2, 18.2, 20.4, 18.9)
    # Middle, east: an open-plan room with two entrances and two glass boxes.
    o.wall_v(35.3, 10.2, 19.8)
    o.wall_h(35.2, 50, 10.3)
    o.wall_h(35.2, 50, 19.7)
    o.door_v(35.3, 11.2, 1.4)
    o.door_h(38.0, 19.7, 1.4)
    o.door_h(47.0, 10.3, 1.4)
    o.wall_v(45.6, 15.4, 19.8)
    o.wall_h(45.6, 50, 15.4)
    o.door_v(45.6, 17.2, 1.0)
    o.table(46.7, 17.2, 1.9, 0.9)
    o.desk_island(37.0, 12.6)
    o.desk_island(41.4, 12.6)
    o.workplace(37.0, 17.2, False)
    o.workplace(40.4, 17.2, False)
    c.fill(43.2, 17.4, 43.6, 19.6)
    c.fill(47.2, 12.4, 47.6, 14.0)
    starts = block_of_starts(2.2, 14.2, 4, 4, 0.8)
    starts = [s for s in starts if not (s[0] > 4.5)]
    starts += block_of_starts(1.0, 8.7, 8, 1, 0.9) + block_of_starts(1.0, 20.9, 4, 1, 0.9)
    return World("office", "made for this project: one floor of an office building, 50 x 30 m, with a lobby, corridors, "
                 "rooms, doors of 1.0 to 1.4 m and furniture", c, starts, robots(4, 0.6, 6, 0.2))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--png", type=pathlib.Path, help="also draw pictures, into this directory")
    arguments = parser.parse_args()
    for make in (field, office1, office2, urban, labyrinth, office):
        world = make()
        (HERE / f"{world.name}.txt").write_text(world.text())
        if arguments.png:
            arguments.png.mkdir(parents=True, exist_ok=True)
            world.png(arguments.png / f"{world.name}.png", max(2, 1000 // world.canvas.width))


if __name__ == "__main__":
    main()
