#!/usr/bin/env python3
"""Checks #include lines: allowed dependencies (the link line does not cover header-only use), and no cycles.

usage: includes_test.py ROOT      exit code 1 and one line per violation of a rule
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
ROOMS = ("schema", "mapper", "server", "client")

FEATURE_TYPES = ["schema/feature/types", "schema/feature/descriptor.h", "schema/feature/pca_projection.h"]
BASE = "schema/base/"
COMMAND = "schema/command/"

# Part of the tree (the first that fits) -> parts of the project its files may include.
MAY_INCLUDE = {
    "schema/base/": [BASE],
    "schema/command/": [BASE, COMMAND],
    "schema/geo/": [BASE, "schema/geo/"],
    "schema/document/": [BASE, "schema/document/"],
    "schema/store/": [BASE, "schema/document/", "schema/geo/datum.h", "schema/store/"],
    "schema/tile/": [BASE, "schema/geo/geodesy.h", "schema/tile/", *FEATURE_TYPES],
    "schema/feature/types": [BASE, *FEATURE_TYPES],
    "schema/feature/": [BASE, "schema/geo/", "schema/feature/"],
    "schema/page/": [BASE, "schema/geo/geodesy.h", "schema/page/"],
    "schema/drive/": [BASE, "schema/geo/", "schema/drive/"],
    "mapper/": ["mapper/", "schema/"],
    "server/viewer/": ["server/", BASE, "schema/geo/", "schema/tile/"],
    "server/routes/viewer.cc": ["server/", "schema/tile/layer_parameters.h"],
    "server/": ["server/", BASE, COMMAND, "schema/document/", "schema/store/", "schema/geo/"],
    "client/estimation/": [],
    "client/cache/": ["client/cache/", BASE, "schema/store/"],
    "client/fetch/": ["client/fetch/", "client/cache/", BASE, "schema/command/version.h",
                      "schema/document/", "schema/geo/", "schema/store/", "schema/tile/",
                      *FEATURE_TYPES],
    "client/localize/": ["client/localize/", "client/estimation/", "client/fetch/", BASE,
                         "schema/geo/", "schema/tile/", "schema/feature/"],
    "client/global/": ["client/global/", "client/estimation/", BASE, "schema/geo/", "schema/tile/"],
    "client/include/": [],
    "client/face/": ["client/face/", "client/global/", "client/localize/", "client/fetch/", BASE,
                     "schema/document/signing_key.h",
                     "schema/geo/", "schema/tile/", "schema/feature/"],
    "client/examples/": [],
    "client/evaluate/report/": ["client/", "schema/"],
    "client/evaluate/": ["client/", "schema/"],
    "client/cli/": ["client/", "schema/"],
    "client/main.cc": ["client/", "schema/"],
}

# Library -> parts of the tree whose files must not reach it, through no chain of our headers.
NOT_REACHED = {
    "opencv2/": [BASE, COMMAND, "schema/document/", "schema/geo/", "schema/store/", "schema/tile/",
                 "server/", *FEATURE_TYPES],
    "Eigen/": [BASE, COMMAND, "schema/document/", "schema/store/", "server/"],
}


def starts_with_any(path, prefixes):
    return any(path.startswith(prefix) for prefix in prefixes)


def includes_of(root, path):
    """(project includes, other includes) of one file of the tree."""
    ours, others = [], []
    for quote, name in INCLUDE.findall((root / path).read_text(encoding="utf-8")):
        (ours if quote == '"' and name.split("/")[0] in ROOMS else others).append(name)
    return ours, others


def chain_to(library, path, includes):
    """The shortest chain of files from `path` to a header of the library, or None."""
    chains, seen = [[path]], {path}
    while chains:
        chain = chains.pop(0)
        ours, others = includes.get(chain[-1], ([], []))
        for name in others:
            if name.startswith(library):
                return chain + [name]
        for name in ours:
            if name not in seen:
                seen.add(name)
                chains.append(chain + [name])
    return None


def room_of(path):
    return path.rsplit("/", 1)[0]


def circles_among(edges):
    """Each cycle of a graph once, as the list of its nodes; `edges`: node -> nodes."""
    circles, done = [], set()

    def walk(node, way):
        if node in way:
            circles.append(way[way.index(node):] + [node])
            return
        if node in done:
            return
        for following in sorted(edges.get(node, ())):
            walk(following, way + [node])
        done.add(node)

    for node in sorted(edges):
        walk(node, [])
    return circles


def circles_of(includes):
    """Cycles of files, and of folders; the files of an inner folder do not belong to the outer one."""
    files = {path: {name for name in ours if name in includes} for path, (ours, _) in includes.items()}
    rooms = {}
    for path, names in files.items():
        rooms.setdefault(room_of(path), set()).update(room_of(name) for name in names)
    for room, others in rooms.items():
        others.discard(room)
    return circles_among(files) + circles_among(rooms)


def faults_of(root):
    files = sorted(str(path.relative_to(root)) for room in ROOMS
                   for path in (root / room).rglob("*") if path.suffix in (".h", ".cc"))
    includes = {path: includes_of(root, path) for path in files}
    for path in files:
        part = next((part for part in MAY_INCLUDE if path.startswith(part)), None)
        if part is None:
            yield f"{path}: lies in no room that MAY_INCLUDE of tests/system/includes_test.py names"
            continue
        for name in includes[path][0]:
            if not starts_with_any(name, MAY_INCLUDE[part]):
                yield f"{path}: includes {name}; {part} may include only {MAY_INCLUDE[part]}"
        for library, parts in NOT_REACHED.items():
            chain = chain_to(library, path, includes) if starts_with_any(path, parts) else None
            if chain:
                yield f"{path}: reaches {library} through {' -> '.join(chain)}"
    for circle in circles_of(includes):
        yield "circle of includes: " + " -> ".join(circle)
    if not files:
        yield f"{root}: holds no source file"


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    faults = list(faults_of(Path(sys.argv[1])))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
