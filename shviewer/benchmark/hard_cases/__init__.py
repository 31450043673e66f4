"""Hard cases of spherical-harmonic arithmetic, each with its right answer and the error of this program.

evaluation, identities, projecting, radiances, rotating and ringing declare the cases; exact makes references to 60 digits;
views and shader draw the cases that concern the fragment shader; cases runs all of them, and table shows the results.
"""

from shviewer.benchmark.hard_cases.cases import CASES, run
from shviewer.benchmark.hard_cases.outcome import Case, Outcome
from shviewer.benchmark.hard_cases.table import as_json, as_markdown, as_text

__all__ = ["CASES", "Case", "Outcome", "as_json", "as_markdown", "as_text", "run"]
