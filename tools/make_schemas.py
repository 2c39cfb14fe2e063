"""Write the JSON Schemas of `jacaros.editors.schemas`, for editors that read schemas from files.

make_schemas.py [FOLDER]      FOLDER instead of docs/reference/schemas; a test compares the two
"""

import json
import sys
from pathlib import Path

from jacaros.editors.schemas import SCHEMAS

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "reference" / "schemas"

PLACE = "https://raw.githubusercontent.com/jacaros/jacaros/main/docs/reference/schemas/"
"""Where editors find them."""


def main(folder: Path) -> None:
    """Write the schemas."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, schema in SCHEMAS.items():
        whole = {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "$id": f"{PLACE}{name}.json",
            "title": f"JaCaROS: {name}",
            **schema(),
        }
        (folder / f"{name}.json").write_text(
            json.dumps(whole, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
