"""kill -9 while plan.json is written: the file is always whole, old or new.

``python -m tests.campaigns.killed_writes --count 300 --seed 1``
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from tests.campaigns.plain_referee import arguments

WRITER = """
import json, sys
from thalweg.core.file_writing import write_text
number = 0
while True:
    number += 1
    write_text(sys.argv[1], json.dumps({"number": number, "body": "x" * 2_000_000}))
"""


def main() -> int:
    """Run the campaign; return 1 if half a file was seen."""
    chosen = arguments(300)
    rng = np.random.default_rng(chosen.seed)
    half = whole = left = 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plan.json"
        while whole + half < chosen.count:
            writer = subprocess.Popen([sys.executable, "-c", WRITER, str(path)])
            before = path.stat().st_mtime_ns if path.exists() else 0
            while not path.exists() or path.stat().st_mtime_ns == before:
                time.sleep(0.002)
            # several looks at a running writer, then the kill
            time.sleep(float(rng.uniform(0.0, 0.05)))
            os.kill(writer.pid, signal.SIGKILL)
            writer.wait()
            try:
                whole += int(len(json.loads(path.read_text())["body"]) == 2_000_000)
            except ValueError:
                half += 1
            others = [p for p in Path(folder).iterdir() if p != path]
            left += len(others)
            for other in others:
                other.unlink()
    print(f"{chosen.count} kills: {whole} whole files, {half} half; {left} temporary files left")
    return int(half > 0)


if __name__ == "__main__":
    sys.exit(main())
