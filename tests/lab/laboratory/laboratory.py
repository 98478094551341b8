"""One run of the laboratory: stages are planned and run, their results counted, and everything is written."""
import collections
import json
import pathlib

import numpy as np

from . import claims as paper_claims
from . import evidence, figures, honesty, paper, report, results, statistics, studies, tables
from .fixes import column, read_estimates, read_regressions, read_run
from .regressions import regression_table, samples_of
from .road import read_roads
from .runs import Planner
from .pairs import study_pairs

CLAIMS_NOTE = (
    "Differences of means (or variances) over the frames that both methods localized, with the 95 % interval of a "
    f"paired bootstrap: {statistics.BOOTSTRAP_DRAWS} draws of blocks of {statistics.BLOCK_FRAMES} neighbouring frames, "
    "since neighbours err alike; the seed is fixed. A claim that one is better is held when the whole interval says "
    "so.")


class Laboratory:
    """Holds what a run found: `fixes` of every pair and method, studies by name, claims."""

    def __init__(self, name, pairs, methods, study_names, situations=()):
        self.name = name
        self.pairs = pairs
        self.methods = methods
        self.study_names = study_names
        self.planner = Planner(methods)
        ahead = [pair for pair in pairs if honesty.REVERSED not in pair.tags]
        self.runs = [self.planner.run(pair, estimates=True) for pair in ahead]
        self.study_runs = {study: studies.plan(studies.STUDIES[study], self.planner, study_pairs(ahead), methods)
                           for study in study_names if study in studies.STUDIES}
        self.honesty_runs = (honesty.plan(self.planner, pairs, methods, situations)
                             if "honesty" in study_names else {})
        self.evidence_runs = evidence.plan(self.planner, ahead) if "evidence" in study_names else {}

    def measure(self, cache):
        """Runs all stages, then reads and counts."""
        cache.run(run.evaluation for run in [*self.runs, *(
            run for by_value in [*self.study_runs.values(), self.honesty_runs, self.evidence_runs]
            for runs in by_value.values() for run in runs)])
        self.fixes = [fixes for run in self.runs for fixes in read_run(run)]
        self.estimates = {method: errors for method in self.methods
                          if len(errors := self.estimate_errors(method))}
        self.normality = {method: statistics.normality_of(errors) for method, errors in self.estimates.items()}
        self.samples_from, self.samples = next(
            ((run.pair.name, samples_of(rows)) for run in self.runs if (rows := read_regressions(run))), ("", []))
        self.studies = [studies.outcome(studies.STUDIES[study], runs)
                        for study, runs in self.study_runs.items()]
        if "lateral" in self.study_names:
            self.studies.append(studies.lateral_outcome(self.shown()))
        if self.honesty_runs:
            self.studies.append(honesty.outcome(self.honesty_runs))
        if self.evidence_runs:
            self.studies.append(evidence.outcome(self.evidence_runs))
        self.claims = paper_claims.claims_of(self.fixes, self.normality.get("tracklet-regression"))
        self.tables = [tables.table_1(self.fixes), tables.table_2(self.fixes), tables.calibration_table(self.fixes)]
        self.precision = tables.precision_table(self.fixes)
        if self.normality:
            self.tables.append(tables.normality_table(self.normality))

    def shown(self):
        """Without the variant that only a claim needs."""
        return [each for each in self.fixes if each.method != paper.UNAVERAGED]

    def estimate_errors(self, method):
        """Per-tracklet errors in metres, of all pairs together."""
        found = [column(rows, "error_m") for run in self.runs if (rows := read_estimates(run, method))]
        errors_m = np.concatenate(found) if found else np.array([])
        return errors_m[np.isfinite(errors_m)]

    def write(self, out):
        """All files of the run, into a folder."""
        out = pathlib.Path(out)
        out.mkdir(parents=True, exist_ok=True)
        by_pair = tables.table_1_by_pair(self.fixes)
        more = [regression_table(self.samples)] if self.samples else []
        for table in [*self.tables, *more, by_pair, self.precision, self.latency(),
                      tables.precision_latency_table(self.fixes), *(table for study in self.studies for table in (study.table, study.more) if table)]:
            (out / f"{table.name}.txt").write_text(table.as_text(), encoding="utf-8")
            (out / f"{table.name}.csv").write_text(table.as_csv(), encoding="utf-8")
        (out / "claims.txt").write_text(self.claims_text(), encoding="utf-8")
        (out / "report.html").write_text(self.report(by_pair), encoding="utf-8")

    def latency(self):
        return tables.latency_table([
            (run.pair.name, json.loads((run.evaluation.result / "summary.json").read_text(encoding="utf-8")))
            for run in self.runs])

    def claims_text(self):
        return "".join(f"{claim.verdict.upper():10}  {claim.text}\n            {claim.figures}\n"
                       for claim in self.claims) + f"\n{CLAIMS_NOTE}\n"

    def text(self):
        """What a run prints at its end."""
        precision = tables.precision_latency_table(self.fixes)
        return "\n".join([*(table.as_text() for table in [*self.tables, precision, *(study.table for study in self.studies)]),
                          self.claims_text()])

    def results_section(self, command):
        return results.section(self.name, command, [*self.tables, self.precision, tables.table_1_by_pair(self.fixes),
                                                    *(study.table for study in self.studies)], self.claims)

    def lead(self):
        best = min((statistics.figures_of(tables.of_method(self.fixes, method)).mean_m, method)
                   for method in tables.methods_of(self.fixes))
        held = sum(claim.verdict == "held" for claim in self.claims)
        tested = sum(claim.verdict != "not tested" for claim in self.claims)
        return (f"{best[1]} has the smallest mean error of {len(self.methods)} methods: {best[0]:.2f}\u00a0m over "
                f"{len(self.pairs)} pair{'s' * (len(self.pairs) != 1)} of drives. Of the {tested} claims tested, "
                f"{held} held.")

    def facts(self):
        roads = {run.map_file: read_roads(run.map_file) for run in self.runs}
        every = [road for of_map in roads.values() for road in of_map.values()]
        curved = np.concatenate([each.curved for each in tables.of_method(self.fixes, self.methods[0])])
        tags = collections.Counter(tag for pair in self.pairs for tag in pair.tags if tag != "study")
        return [("Pairs", ", ".join(pair.name for pair in self.pairs)),
                ("Maps", f"{len(roads)}, {sum(road.length_m for road in every):.0f} m of road"),
                ("Query frames", f"{len(curved)}, {100 * curved.mean():.0f} % of them on curved road"),
                *([("Kinds", ", ".join(f"{tag} ({count})" for tag, count in sorted(tags.items())))] if tags else [])]

    def report(self, by_pair):
        shown = self.shown()
        body = [
            report.table(self.tables[0]),
            report.figure("Mean error beside the paper's", figures.means_beside_paper(self.fixes),
                          "Discs: here, all pairs together. Upright strokes: Table 1 of the paper, on its own drives. "
                          "The axis is logarithmic."),
            report.table(self.precision),
            report.claims(self.claims, CLAIMS_NOTE),
            report.figure("Figure 5: error along the route", figures.error_along_route(shown),
                          f"A panel a pair. Lines: mean of the absolute error over {figures.RUNNING_WINDOW_M:.0f} m of "
                          "road; dots: single frames. The axis is logarithmic, and what is below "
                          f"{1000 * figures.LEAST_SHOWN_M:.0f} mm is drawn there."),
            report.figure("Errors of all pairs together", figures.error_distribution(shown),
                          "Share of localized frames with no larger error, on a logarithmic axis."),
            report.table(self.tables[1]),
            report.figure("Figure 6: error by road type", figures.error_by_road_type(shown),
                          "Share of localized frames with no larger error. Triangles at the foot: the means."),
            *self.regression_figures(),
            *self.estimate_figures(),
            report.table(self.tables[2]),
        ]
        if self.studies:
            body.append(report.part("Studies"))
            for study in self.studies:
                body += [report.figure(study.title, study.figure, study.caption), report.folded(study.table)]
        body += [report.part("Pair by pair"), report.table(by_pair)]
        return report.page(self.name, self.lead(), self.facts(), body)

    def estimate_figures(self):
        parts = []
        for method in ("tracklet-regression", "inverse-scale", "milepost"):
            if method in self.estimates:
                parts.append(report.figure(
                    f"Figure 8: errors of single tracklets, {method}",
                    figures.estimate_histogram(self.estimates[method], self.normality[method]),
                    "Left: the errors of the single tracklets' estimates against normal densities of mean zero, with "
                    "the deviation of all of them, and with that of the bulk. Right: their quantiles against the "
                    "normal's."))
        return [*parts, report.table(self.tables[3])] if parts else []

    def regression_figures(self):
        if not self.samples:
            return []
        return [report.figure(
            f"Figure 7: sample tracklets of {self.samples_from}", figures.regressions(self.samples),
            "Where a feature was seen at which scale, and its regression line. Left as published, right as milepost "
            "has it: the scale of a feature grows faster the nearer it comes, its inverse evenly."),
            report.table(regression_table(self.samples))]
