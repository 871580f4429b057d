#!/usr/bin/env python3
"""Writes an office of any size as a ROS map (pgm and yaml): corridors every 14 m, rooms of 4 to 6 m with doors of 1 m.

    datasets/make_large_office.py CELLS FOLDER [RESOLUTION] [SEED]

writes FOLDER/office-CELLS.pgm and .yaml. Made for measuring how costs grow with the map; every room can be reached.
"""
import random
import sys

FREE, WALL = 254, 0


def office(cells, resolution, seed):
    """Rows from the top, one bytearray each."""
    rng = random.Random(seed)
    m = lambda metres: max(1, round(metres / resolution))
    grid = [bytearray([FREE]) * cells for _ in range(cells)]
    wall, corridor, block, door = m(0.2), m(2.0), m(14.0), m(1.0)

    def fill(x0, y0, x1, y1, value):
        for y in range(max(y0, 0), min(y1, cells)):
            grid[y][max(x0, 0):min(x1, cells)] = bytes([value]) * max(0, min(x1, cells) - max(x0, 0))

    for by in range(corridor, cells, block):
        for bx in range(corridor, cells, block):  # a block of rooms, two deep, between corridors
            x1, y1 = min(bx + block - corridor, cells), min(by + block - corridor, cells)
            if x1 - bx < m(4.0) or y1 - by < m(4.0):
                fill(bx, by, x1, y1, WALL)
                continue
            middle = (by + y1) // 2
            fill(bx, by, x1, by + wall, WALL)
            fill(bx, y1 - wall, x1, y1, WALL)
            fill(bx, middle, x1, middle + wall, WALL)
            x = bx
            while True:
                fill(x, by, x + wall, y1, WALL)
                if x >= x1 - wall:
                    break
                width = m(rng.uniform(4.0, 6.0))
                following = x + width if x + width <= x1 - m(4.0) else x1 - wall
                for y in (by, y1 - wall):  # a door to each corridor
                    at = rng.randint(x + wall + 1, max(x + wall + 1, following - door - 1))
                    fill(at, y, at + door, y + wall, FREE)
                x = following
    edge = m(0.2)
    fill(0, 0, cells, edge, WALL)
    fill(0, cells - edge, cells, cells, WALL)
    fill(0, 0, edge, cells, WALL)
    fill(cells - edge, 0, cells, cells, WALL)
    return grid


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    cells, folder = int(sys.argv[1]), sys.argv[2]
    resolution = float(sys.argv[3]) if len(sys.argv) > 3 else 0.1
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    name = f"office-{cells}"
    with open(f"{folder}/{name}.pgm", "wb") as image:
        image.write(f"P5\n{cells} {cells}\n255\n".encode())
        image.writelines(office(cells, resolution, seed))
    with open(f"{folder}/{name}.yaml", "w") as yaml:
        yaml.write(f"image: {name}.pgm\nresolution: {resolution}\norigin: [0, 0, 0]\nnegate: 0\n"
                   "occupied_thresh: 0.65\nfree_thresh: 0.196\n")


if __name__ == "__main__":
    main()
