#!/usr/bin/env python3
"""Table of how signs and leaf tests were decided, from a run of method bvh with statistics = true.

    results/tabulate_decisions.py RUN > results/accuracy/decisions.csv

One row per scene. Of the judge: signs the floating-point filter vouched for, signs that needed exact
arithmetic. Of bvh, for query = beam and lane: tests of a point and a triangle that single precision left to
double precision, and those that went on to error-free sums.
"""
import csv
import json
import pathlib
import sys

JUDGE = ["points", "truth_filtered", "truth_exact"]
LEAF = ["fp64_decisions", "exact_decisions"]


def median(result, metric):
    return result["metrics"].get(metric, {}).get("median", "")


def main():
    summary = json.loads(pathlib.Path(sys.argv[1], "summary.json").read_text())
    scenes = {}
    for result in summary["results"]:
        kind = "judge" if result["method"] == "(scene)" else result["variant"].split(",")[0][6:]
        scenes.setdefault(result["scene"], {})[kind] = result
    table = csv.writer(sys.stdout, lineterminator="\n")
    queries = ["beam", "lane"]
    table.writerow(["scene", *JUDGE, *(f"{query}_{metric}" for query in queries for metric in LEAF)])
    for scene, of in scenes.items():
        row = [median(of["judge"], metric) for metric in JUDGE]
        row += [median(of[query], metric) for query in queries for metric in LEAF]
        table.writerow([scene, *(f"{x:.10g}" if x != "" else "" for x in row)])


if __name__ == "__main__":
    main()
