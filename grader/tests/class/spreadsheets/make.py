#!/usr/bin/env python3
"""Makes the spreadsheets of this folder: a roster and receipt times, with the cells that offices use.

    .ci/validators && target/validators/bin/python grader/tests/class/spreadsheets/make.py
"""

from datetime import datetime
from pathlib import Path

from openpyxl import Workbook

FOLDER = Path(__file__).parent

# Numbers are numbers, and the table begins neither in the first row nor in the first column.
roster = Workbook()
sheet = roster.active
sheet.title = "Teilnehmer"
rows = [
    ("Nachname", "Vorname", "Matrikelnummer", "Benutzername"),
    ("Müller", "Jürgen", 4711001, "jm1"),
    (None, None, None, None),
    ("Öz", "Cem", 4711002, "co2"),
    ("Poe", "Dee", 4711003, "dp3"),
]
for index, row in enumerate(rows):
    for column, value in enumerate(row):
        sheet.cell(row=index + 3, column=column + 2, value=value)
roster.create_sheet("Notizen").append(["nobody", "reads", "this"])
roster.save(FOLDER / "roster.xlsx")

# Times are dates of the spreadsheet, or texts as a person types them.
received = Workbook()
sheet = received.active
sheet.append(["student", "received_at", "team"])
sheet.append([4711001, datetime(2026, 5, 22, 0, 59, 0), None])
sheet.append(["co2", "21.05.2026 23:41", None])
received.save(FOLDER / "received.xlsx")
