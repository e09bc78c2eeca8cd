#!/usr/bin/env python3
"""Lists imports that point upwards: `python3 tools/borders.py` from the root of the repository.

Reads `use`, and paths that begin with `crate`, `super`, `self`, a child module or another crate of
the table, and follows re-exports to the file of the item. Tests and comments do not count. `-v`
also prints how often each layer uses each other layer.
"""

import collections
import pathlib
import re
import sys

# A crate: the crates that it may use, then its layers from the bottom. A path uses only what stands
# above its own line here; names on one line do not use each other. What no line names belongs to the
# nearest folder that has one, and to the last line otherwise.
CRATES = {
    "pendulum-compiler": (
        [],
        """
        messages
        algebra
        syntax
        model
        schedule
        mechanics
        backend
        compile
        """,
    ),
    "pendulum-macros": (["pendulum-compiler"], ""),
    "pendulum-core": (
        ["pendulum-macros"],
        """
        error macros simd
        scalar
        time
        attitude
        body
        motion
        system
        jet
        integrate/linear integrate/stats integrate/times
        integrate/field
        integrate/state
        integrate/interpolant
        integrate/method integrate/events
        integrate/schemes integrate/step
        integrate/methods
        integrate/solution
        integrate/data integrate/observe integrate/pace
        integrate/output
        integrate/settings
        integrate/integrator
        integrate/solve
        integrate/batch
        integrate/assemble integrate/members
        integrate
        analysis
        """,
    ),
    "pendulum-body": (["pendulum-core"], ""),
    "pendulum-scene": (
        ["pendulum-core"],
        """
        error handle threads
        system
        sampling
        bone
        lanes
        group
        contact
        scene
        advance state
        features
        """,
    ),
    "pendulum-import": (["pendulum-body", "pendulum-core"], ""),
    "pendulum-ensemble": (["pendulum-core"], ""),
    "pendulum-runtime": (
        ["pendulum-body", "pendulum-core", "pendulum-ensemble", "pendulum-import", "pendulum-scene"],
        "",
    ),
    "pendulum-mpi": (["pendulum-runtime"], ""),
}

TOKEN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?\*/|b?"(?:\\.|[^"\\])*"|b?r(?P<h>\#*)".*?"(?P=h)|b?'(?:\\.[^']*|[^\\'])'|'\w+)"""
    r"|(?P<word>\$?\w+)|(?P<sign>::|\S)|(?P<line>\n)",
    re.S,
)


def tokens(text):
    """Returns the words and signs of a file with their lines, without comments and strings."""
    line, found = 1, []
    for match in TOKEN.finditer(text):
        if match["word"] or match["sign"]:
            found.append((match[0].replace("$crate", "crate"), line))
        line += match[0].count("\n")
    return found


def closed(items, at):
    """Returns the place after the bracket that closes the one at `at`."""
    depth = 0
    for place in range(at, len(items)):
        depth += (items[place][0] in "([{") - (items[place][0] in ")]}")
        if depth == 0:
            return place + 1
    return len(items)


def untested(items):
    """Leaves out what `#[cfg(test)]` and `#[test]` stand before."""
    kept, at = [], 0
    while at < len(items):
        if items[at][0] == "#" and items[at + 1][0] == "[":
            end = closed(items, at + 1)
            words = [word for word, _ in items[at:end]]
            if "test" in words and "not" not in words and ("cfg" in words or len(words) == 4):
                while items[end][0] not in "{;":
                    end = closed(items, end) if items[end][0] in "([" else end + 1
                end = closed(items, end) if items[end][0] == "{" else end + 1
            at = end
        else:
            kept.append(items[at])
            at += 1
    return kept


def branches(items, at, path):
    """Yields the paths of a tree of `use` with their lines and names, then the place after it."""
    while True:
        word, line = items[at]
        if word == "{":
            at += 1
            while items[at][0] != "}":
                at = yield from branches(items, at, path)
                at += items[at][0] == ","
            return at + 1
        if word != "::":
            path = path + (word,)
        at += 1
        if items[at][0] not in ("::", "{") and word != "::":
            name = path[-1] if word != "self" else path[-2]
            if items[at][0] == "as":
                name, at = items[at + 1][0], at + 2
            yield path[:1] + tuple(part for part in path[1:] if part != "self"), line, name
            return at


class Crate:
    """The modules of a crate, what they import and what they mention."""

    def __init__(self, name, root):
        self.name, self.root = name, root
        self.files, self.names, self.globs = {(): root / "src/lib.rs"}, {}, collections.defaultdict(list)
        self.items, self.uses, self.macros = collections.defaultdict(set), [], {}
        self.read((), root / "src/lib.rs", root / "src")

    def read(self, module, file, folder):
        text = file.read_text()
        self.files[module] = file
        self.walk(untested(tokens(text)), module, file, folder)

    def walk(self, items, module, file, folder):
        inside, depth, at, children = [], 0, 0, set()
        pairs = zip(items, items[1:])
        children = {b for (a, _), (b, _) in pairs if a == "mod"}
        while at < len(items):
            word, line = items[at]
            here = module + tuple(name for name, _ in inside)
            after = items[at + 1][0] if at + 1 < len(items) else ""
            if word == "mod" and re.fullmatch(r"\w+", after):
                if items[at + 2][0] == "{":
                    inside.append((after, depth))
                    self.files[here + (after,)] = file
                else:
                    within = folder.joinpath(*here[len(module) :])
                    path = within / f"{after}.rs"
                    path = path if path.exists() else within / after / "mod.rs"
                    self.read(here + (after,), path, within / after)
                at += 2
                continue
            depth += (word == "{") - (word == "}")
            if word == "}" and inside and inside[-1][1] == depth:
                inside.pop()
            if word == "macro_rules":
                self.macros[items[at + 2][0]] = here
            if word in ("struct", "enum", "trait", "fn", "type", "const", "static", "union"):
                self.items[here].add(after)
            if word == "use" and after != "<":
                tree = branches(items, at + 1, ())
                while True:
                    try:
                        path, place, name = next(tree)
                    except StopIteration as stop:
                        at = stop.value
                        break
                    self.uses.append((here, path, file, place))
                    if name == "*":
                        self.globs[here].append(path[:-1])
                    else:
                        self.names[here, name] = path
                continue
            before = items[at - 1][0] if at else ""
            if after == "::" and before not in ("::", "in") and (word in FIRST or word in children):
                path = [word]
                while at + 2 < len(items) and items[at + 1][0] == "::" and re.match(r"\w", items[at + 2][0]):
                    at += 2
                    path.append(items[at][0])
                self.uses.append((here, tuple(path), file, line))
            at += 1

    def resolve(self, here, path, seen=()):
        """Returns the crate and the module in which the item of a path stands."""
        first, rest = path[0], path[1:]
        if first in IDENTS and (here + (first,)) not in self.files:
            return IDENTS[first], ()
        if first == "crate":
            here = ()
        elif first == "super":
            here = here[:-1]
        elif first != "self":
            rest = path
        for index, name in enumerate(rest):
            if name == "super":
                here = here[:-1]
            elif here + (name,) in self.files:
                here += (name,)
            elif (here, name) in self.names and (here, name) not in seen:
                return self.resolve(here, self.names[here, name] + rest[index + 1 :], seen + ((here, name),))
            elif name in self.items[here] or name == "*":
                break
            else:
                for glob in self.globs[here]:
                    target, module = self.resolve(here, glob, seen + ((here, "*"),))
                    if target == self.name and (module, name) in self.names:
                        return self.resolve(module, ("self", name, *rest[index + 1 :]), seen)
                    if target == self.name and name in self.items[module]:
                        return self.name, module
                if here == () and first != "crate":
                    return None, ()
                return self.name, self.macros.get(name, here) if here == () else here
        return self.name, here


ROOT = pathlib.Path(__file__).resolve().parent.parent
IDENTS = {name.replace("-", "_"): name for name in CRATES}
FIRST = {"crate", "super", "self", *IDENTS}


def main():
    upwards, counts, known = 0, collections.Counter(), set()
    for name, (below, table) in CRATES.items():
        if not (ROOT / name).exists():
            continue
        crate = Crate(name, ROOT / name)
        rows = [row.split() for row in table.split("\n") if row.strip()]
        ranks = {tuple(path.split("/")): rank for rank, row in enumerate(rows) for path in row}
        missing = [path for path in ranks if path not in crate.files]
        assert not missing, f"{name}: no module {missing}"

        def layer(module):
            while module and module not in ranks:
                module = module[:-1]
            return module, ranks.get(module, len(rows))

        for here, path, file, line in crate.uses:
            target, module = crate.resolve(here, path)
            if target is None:
                continue
            if target != name:
                wrong, label = target not in below, target
            else:
                (mine, low), (other, high) = layer(here), layer(module)
                wrong, label = high > low or high == low and mine != other, "/".join(other) or "lib.rs"
                counts["/".join(mine) or "lib.rs", label] += mine != other
            place = (file, line, label)
            if wrong and place not in known:
                known.add(place)
                upwards += 1
                print(f"{file.relative_to(ROOT)}:{line}: `{'::'.join(path)}` points up, to {label}")
    if "-v" in sys.argv:
        for (mine, other), count in sorted(counts.items()):
            print(f"{mine:24} {other:24} {count:5}")
    if upwards:
        sys.exit(f"{upwards} imports point up")


main()
