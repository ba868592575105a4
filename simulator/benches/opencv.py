"""The stages of sensing that OpenCV has, timed one image at a time on one thread.

`opencv.rs` writes what is needed into a folder, and a line to this program's standard input for each
run; each is answered with the microseconds of each stage: HSV, back-projection with its threshold,
unwrapping, connected components.
"""

import sys
import time
from pathlib import Path

import cv2
import numpy

SIDE = 800


def main() -> None:
    folder = Path(sys.argv[1])
    cv2.setNumThreads(1)
    image = cv2.imread(str(folder / "image.png"))
    labels = cv2.imread(str(folder / "labels.png"))
    u, v = (
        numpy.fromfile(folder / name, dtype="<f4").reshape(SIDE, SIDE) for name in ("u.f32", "v.f32")
    )
    table = cv2.convertMaps(u, v, cv2.CV_16SC2, nninterpolation=True)
    # The stripe is red in the label mask; OpenCV's order is blue, green, red.
    stripe = cv2.inRange(labels, (0, 0, 255), (0, 0, 255))
    ranges = [0, 180, 0, 256, 0, 256]
    histogram = cv2.calcHist(
        [cv2.cvtColor(image, cv2.COLOR_BGR2HSV)], [0, 1, 2], stripe, [30, 32, 32], ranges
    )
    cv2.normalize(histogram, histogram, 0, 255, cv2.NORM_MINMAX)
    print("ready", cv2.__version__, flush=True)
    for _ in sys.stdin:
        at = [time.perf_counter()]
        hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
        at.append(time.perf_counter())
        likely = cv2.calcBackProject([hsv], [0, 1, 2], histogram, ranges, 1)
        _, found = cv2.threshold(likely, 30, 255, cv2.THRESH_BINARY)
        at.append(time.perf_counter())
        ground = cv2.remap(found, table[0], table[1], cv2.INTER_NEAREST)
        at.append(time.perf_counter())
        cv2.connectedComponentsWithStats(ground, connectivity=8)
        at.append(time.perf_counter())
        print(*(round(1e6 * (end - start)) for start, end in zip(at, at[1:])), flush=True)


if __name__ == "__main__":
    main()
