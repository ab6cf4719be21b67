"""What the chart scripts share: the table that a benchmark prints, measured now or kept from before."""

import csv
import subprocess
from pathlib import Path


def measure(program: Path, size: int | None) -> Path:
    """Runs the program, with its size where one is given; what it prints goes to PROGRAM.csv, which is returned."""
    out = program.with_name(program.name + ".csv")
    with out.open("w") as file:
        subprocess.run([str(program)] + ([str(size)] if size else []), check=True, stdout=file)
    return out


def read(path: Path, names: set[str]) -> list[dict]:
    """The rows of a table; its columns are numbers but for those of `names`."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key in row.keys() - names:
            row[key] = float(row[key])
    return rows
