"""Pictures as the tool writes them, compared pixel by pixel."""

import numpy
from PIL import Image


class Picture:
    def __init__(self, path):
        with Image.open(path) as image:
            self.colors = numpy.asarray(image.convert("RGB")).astype(int)  # [y, x, component]
        self.height, self.width, _ = self.colors.shape

    def pixel(self, x, y):
        return tuple(map(int, self.colors[y, x]))


def unlike(a, b, tolerance):
    """Which pixels differ by more in a component, as [y, x]."""
    return (abs(a.colors - b.colors) > tolerance).any(axis=2)


def differing(a, b, tolerance):
    """The share of pixels that differ by more in a component."""
    return unlike(a, b, tolerance).mean()


def covered(picture):
    """The share of pixels that are not the background, which is nearly grey."""
    background = picture.colors[:, :1]
    return (abs(picture.colors - background) > 8).any(axis=2).mean()
