#!/usr/bin/env python3
"""The stages of the session desertscape_session in one picture: figure 17 of Paris et al. 2019.

    test/bench/session_stages.py --out PICTURE.jpg [--programs FOLDER]

desert_run films the scenario; the pictures of the ends of six stages go into one. --programs: where desert_run lies
(default: looked for in $PATH).
"""
import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image

SCENARIO = pathlib.Path(__file__).resolve().parents[2] / "config/scenarios/desertscape_session.yaml"
STAGES = (600, 1200, 1500, 1800, 2400, 3600)  # steps: barchans, yardangs, ridges, nebkhas, mega-barchans, domes
EVERY, WIDTH, HEIGHT, COLUMNS = 300, 400, 260, 3  # steps from picture to picture; of a picture [px]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--programs", type=pathlib.Path)
    o = parser.parse_args()
    program = str(o.programs / "desert_run") if o.programs else "desert_run"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, str(SCENARIO), "--quiet", "--film", folder, "--film-every", str(EVERY),
                        "--view", "width=%d" % (2 * WIDTH), "--view", "height=%d" % (2 * HEIGHT), "--view", "zoom=1.0"],
                       check=True)
        frames = [Image.open(pathlib.Path(folder) / ("frame_%06d.png" % (step // EVERY))) for step in STAGES]
        table = Image.new("RGB", (COLUMNS * WIDTH, len(STAGES) // COLUMNS * HEIGHT))
        for n, frame in enumerate(frames):
            table.paste(frame.resize((WIDTH, HEIGHT), Image.LANCZOS), (n % COLUMNS * WIDTH, n // COLUMNS * HEIGHT))
    table.save(o.out, quality=85)


if __name__ == "__main__":
    main()
