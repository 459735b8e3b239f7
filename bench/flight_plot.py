#!/usr/bin/env python3
"""Flights of bench/stream as a picture: error on screen, memory and time of a frame.

    bench/flight_plot.py docs/pictures/flight.png disk=disk.csv "20 Mbit/s=serve.csv"
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def columns(path):
    with open(path, newline="") as lines:
        rows = list(csv.DictReader(lines))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def main():
    target, flights = sys.argv[1], [a.split("=", 1) for a in sys.argv[2:]]
    figure, axes = plt.subplots(3, 1, figsize=(9, 7), sharex=True, layout="constrained")
    for label, path in flights:
        data = columns(path)
        at = data["seconds"]
        axes[0].plot(at, [max(e, 0.1) for e in data["error_pixels"]], linewidth=1, label=label)
        axes[1].plot(at, data["resident_mb"], linewidth=1, label=label)
        axes[2].plot(at, data["update_ms"], linewidth=0.6, label=label)
    axes[0].set_yscale("log")
    axes[0].set_ylabel("error on screen, pixels\n(bound of the worst block)")
    axes[1].set_ylabel("resident blocks, MB")
    axes[2].set_ylabel("update(), ms")
    axes[2].set_xlabel("seconds of the flight")
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[0].legend(loc="upper right")
    figure.savefig(target, dpi=110)


if __name__ == "__main__":
    main()
