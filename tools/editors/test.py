#!/usr/bin/env python3
"""Asks rust-analyzer what an editor asks it inside of `lagrangian!` blocks.

    rustup component add rust-analyzer
    python3 tools/editors/test.py

Each check is a text with the cursor at `¦`, a request, and the words that must or must not stand in
the answer. `--show` prints all answers, and a word behind it selects checks by name.
"""

import json
import pathlib
import re
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
CRATE = ROOT / "target" / "editors"
CURSOR = "¦"

ARM = """\
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A swing that hangs from a spring.
    pub struct Swing {
        /// The mass of the bob.
        m: kg, L: m, k: N/m, g: m/s^2 = 9.81,
        masses: [kg; 2], frame: body,
    }
    coordinate θ: rad;
    coordinate y: m;
    coordinate φ[2]: rad;
    driven x: [m; 2];
    input u: N*m;
    let r = [L*sin(θ), y - L*cos(θ)] + x;
    let speed = |ṙ|;
    let lift(a) = a*tanh(a/L);
    let arm[k in 0..2] = L*sin(φ[k]);
    kinetic = m/2*speed^2 + sum(j in 0..2, masses[j]/2*L^2*φ̇[j]^2) + m/2*ẏ^2 + 0*y_dot;
    potential = m*g*r.y + k/2*y^2 - m*g*L*cos(φ[0]) + lift(y)*g*m + 0*arm[1]*m*g;
    force θ = u;
    output tension: N = k*y;
    constraint rod: θ = φ[0];
}

fn main() {}
"""


def at(old, new, text=ARM):
    """The text with its only `old` replaced; the cursor is in `new`."""
    assert text.count(old) == 1, (old, text.count(old))
    return text.replace(old, new)


# name, text with the cursor, request, words that stand in the answer, words that do not
CHECKS = [
    # Hover.
    ("parameter", at("m*g*r.y", "¦m*g*r.y"), "hover", ["mass of the bob", "`kg`"], []),
    ("default", at("m*g*r.y", "m*¦g*r.y"), "hover", ["parameter", "`m/s^2`", "9.81"], []),
    ("coordinate", at("k*y;", "k*¦y;"), "hover", ["coordinate", "static y: f64", "`m`"], []),
    ("velocity", at("m/2*ẏ^2", "m/2*¦ẏ^2"), "hover", ["velocity", "`y`", "m/s"], []),
    ("velocity in ascii", at("y_dot", "¦y_dot"), "hover", ["velocity", "`y`", "m/s"], []),
    ("velocity of a family", at("φ̇[j]", "¦φ̇[j]"), "hover", ["velocity", "`[rad/s; 2]`"], []),
    ("family", at("sin(φ[k])", "sin(¦φ[k])"), "hover", ["coordinate", "`[rad; 2]`"], []),
    ("driven input", at("] + x;", "] + ¦x;"), "hover", ["driven", "`[m; 2]`"], []),
    ("control input", at("= u;", "= ¦u;"), "hover", ["control", "`N*m`"], []),
    ("vector definition", at("g*r.y", "g*¦r.y"), "hover", ["definition", "`[m; 2]`", "L*sin(θ)"], []),
    ("rate of a definition", at("|ṙ|", "|¦ṙ|"), "hover", ["velocity", "`[m/s; 2]`"], []),
    ("scalar definition", at("2*speed^2", "2*¦speed^2"), "hover", ["`m/s`", "f64"], ["[f64"]),
    ("function of one's own", at("lift(y)", "¦lift(y)"), "hover", ["lift(a)", "a*tanh(a/L)"], []),
    ("body", at("frame: body", "¦frame: body"), "hover", ["Body"], []),
    ("index", at("masses[j]", "masses[¦j]"), "hover", ["0..2"], []),
    ("function", at("*sin(θ)", "*¦sin(θ)"), "hover", ["sin", "fn"], []),
    ("sum", at("sum(j", "¦sum(j"), "hover", ["sum"], []),
    ("keyword", at("kinetic", "¦kinetic"), "hover", ["kinetic energy"], []),
    ("keyword of a constraint", at("constraint", "¦constraint"), "hover", ["reaction"], []),
    ("unit", at("k: N/m", "k: ¦N/m"), "hover", ["newton", "kg·m/s²"], []),
    ("struct", at("Swing", "¦Swing"), "hover", ["Equations of motion"], []),
    ("declared parameter", at(" L: m, k", " ¦L: m, k"), "hover", ["The parameter `L`"], []),
    ("declared coordinate", at("coordinate y", "coordinate ¦y"), "hover", ["A coordinate in `m`"], []),
    # References: line and column of each.
    ("of a parameter", at(" L: m, k", " ¦L: m, k"), "references", ["7:16", "15:14", "17:28"], []),
    ("of a coordinate", at("k*y;", "k*¦y;"), "references", ["11:16", "15:24", "22:27"], []),
    # Renaming.
    ("a definition", at("2*speed^2", "2*¦speed^2"), "rename", ["16:9", "19:19"], []),
    ("a coordinate", at("coordinate θ", "coordinate ¦θ"), "rename", ["10:16", "15:20", "21:11"], []),
    ("a parameter", at(" L: m, k", " ¦L: m, k"), "rename", ["7:16", "15:14", "17:28"], []),
    # Diagnostics.
    ("of a block without mistakes", at("fn main() {}", "¦fn main() {}"), "diagnostic", [], [""]),
    # Definition.
    ("to the parameter", at("m*g*r.y", "m*¦g*r.y"), "definition", ["7:30"], []),
    ("to the coordinate", at("k*y;", "k*¦y;"), "definition", ["11:16"], []),
    ("from a velocity", at("m/2*ẏ^2", "m/2*¦ẏ^2"), "definition", ["11:16"], []),
    ("from a velocity in ascii", at("y_dot", "¦y_dot"), "definition", ["11:16"], []),
    ("to a definition", at("g*r.y", "g*¦r.y"), "definition", ["15:9"], []),
    ("to a function", at("lift(y)", "¦lift(y)"), "definition", ["17:9"], []),
    ("to an index", at("masses[j]", "masses[¦j]"), "definition", ["19:33"], []),
    # Completion.
    ("name", at("m*g*r.y", "m*g*r.y + spe¦"), "completion", ["speed"], ["vec!", "println"]),
    ("any name", at("m*g*r.y", "m*g*r.y + ¦"), "completion",
     ["θ", "y", "ẏ", "y_dot", "m", "masses", "lift", "arm", "x", "u", "t", "cos", "sum"],
     ["std", "println!", "Swing"]),
    ("name without an end", at("m*g*r.y + k/2*y^2 - m*g*L*cos(φ[0]) + lift(y)*g*m + 0*arm[1]*m*g;",
                               "m*g*r.y + spe¦"), "completion", ["speed"], []),
    ("name in a call", at("*sin(θ)", "*sin(¦)"), "completion", ["θ", "L"], ["println!"]),
    ("name in a magnitude", at("|ṙ|", "|sp¦|"), "completion", ["speed"], []),
    ("name at the end", at("+ 0*arm[1]*m*g;", "+ ¦;"), "completion", ["speed"], ["println!"]),
    ("component", at("g*r.y +", "g*r.¦ +"), "completion", ["x", "y"], ["sin", "println!"]),
    ("constraint", at("= k*y;", "= reaction(¦);"), "completion", ["rod"], ["sin", "k"]),
    ("index of a sum", at("masses[j]", "masses[¦]"), "completion", ["j", "m"], ["println!"]),
    ("argument", at("tanh(a/L)", "tanh(¦)"), "completion", ["a", "L"], ["println!"]),
    ("option", at("constraint rod: θ = φ[0];", "limit low: y >= 0, ¦"), "completion",
     ["restitution"], ["sin", "println!"]),
    ("function name", at("*sin(θ)", "*co¦"), "completion", ["cos", "cosh"], []),
    ("keyword", at("kinetic", "outp¦\n    kinetic"), "completion", ["output"], ["θ", "println!"]),
    ("first keyword", at("force θ = u;", "¦"), "completion", ["force", "kinetic"], ["θ"]),
    ("keyword at the end", at("θ = φ[0];", "θ = φ[0];\n    lim¦"), "completion", ["limit"], []),
    ("unit of a field", at("k: N/m", "k: ¦"), "completion", ["N", "kg", "rad"], ["θ", "String"]),
    ("unit of a coordinate", at("y: m;", "y: r¦;"), "completion", ["rad"], ["θ"]),
    ("coordinate of a force", at("force θ = u;", "force ¦"), "completion", ["θ", "y"], ["sin", "m"]),
]

# What a request asks beside its place.
EXTRA = {
    "references": {"context": {"includeDeclaration": True}},
    "rename": {"newName": "renamed"},
}


class Server:
    """rust-analyzer over its standard streams."""

    def __init__(self, folder):
        self.process = subprocess.Popen(
            ["rust-analyzer"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL)
        self.number = 0
        self.answers = {}
        self.quiet = False
        self.arrived = threading.Condition()
        threading.Thread(target=self.read, daemon=True).start()
        capabilities = {
            "textDocument": {
                "hover": {"contentFormat": ["markdown"]},
                "completion": {"completionItem": {"snippetSupport": True}},
            },
            "window": {"workDoneProgress": False},
            "experimental": {"serverStatusNotification": True},
        }
        settings = {"checkOnSave": False, "cachePriming": {"enable": False}}
        self.ask("initialize", {
            "processId": None, "rootUri": folder.as_uri(), "capabilities": capabilities,
            "initializationOptions": settings})
        self.tell("initialized", {})

    def send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
        self.process.stdin.flush()

    def tell(self, method, parameters):
        self.send({"method": method, "params": parameters})

    def ask(self, method, parameters):
        self.number += 1
        number = self.number
        self.send({"id": number, "method": method, "params": parameters})
        with self.arrived:
            if not self.arrived.wait_for(lambda: number in self.answers, timeout=120):
                raise SystemExit(f"no answer to {method} within two minutes")
            answer = self.answers.pop(number)
        return answer.get("result")

    def read(self):
        stream = self.process.stdout
        while line := stream.readline():
            length = int(line.split(b":")[1])
            while stream.readline().strip():
                pass
            message = json.loads(stream.read(length))
            with self.arrived:
                if "method" in message:
                    if "id" in message:
                        self.send({"id": message["id"], "result": None})
                    if message["method"] == "experimental/serverStatus":
                        self.quiet = message["params"]["quiescent"]
                else:
                    self.answers[message["id"]] = message
                self.arrived.notify_all()

    def wait(self):
        with self.arrived:
            if not self.arrived.wait_for(lambda: self.quiet, timeout=600):
                raise SystemExit("rust-analyzer is not ready after ten minutes")


def crate():
    (CRATE / "src").mkdir(parents=True, exist_ok=True)
    (CRATE / "Cargo.toml").write_text(
        '[package]\nname = "editors"\nedition = "2024"\n\n[dependencies]\n'
        f'pendulum-runtime = {{ path = "{ROOT / "pendulum-runtime"}" }}\n\n[workspace]\n')
    path = CRATE / "src" / "main.rs"
    path.write_text(ARM)
    return path


def readable(request, answer):
    """The answer as text: of a completion the labels, of a definition its places."""
    if not answer:
        return ""
    if request == "hover":
        return answer["contents"]["value"]
    if request == "completion":
        items = answer["items"] if isinstance(answer, dict) else answer
        return "\n".join(item["label"] for item in items)
    if request == "diagnostic":
        return "\n".join(item["message"] for item in answer["items"])
    if request == "rename":
        changes = answer.get("documentChanges") or [{"edits": edits} for edits in answer["changes"].values()]
        answer = [edit for change in changes for edit in change["edits"]]
    places = answer if isinstance(answer, list) else [answer]
    starts = [place.get("targetSelectionRange", place.get("range"))["start"] for place in places]
    return "\n".join(f"{start['line'] + 1}:{start['character'] + 1}" for start in starts)


def stands(request, word, text):
    if request == "diagnostic":
        return text != word
    if request == "hover":
        return word in text
    if request in ("definition", "references", "rename"):
        return word in text.splitlines()
    return any(re.split(r"[(…!]", line)[0] == re.split(r"[(…!]", word)[0]
               for line in text.splitlines())


def main():
    show = "--show" in sys.argv
    chosen = [word for word in sys.argv[1:] if word != "--show"]
    path = crate()
    server = Server(CRATE)
    document = {"uri": path.as_uri()}
    server.tell("textDocument/didOpen", {
        "textDocument": {**document, "languageId": "rust", "version": 0, "text": ARM}})
    server.wait()
    failed = asked = 0
    for version, (name, text, request, wanted, unwanted) in enumerate(CHECKS, 1):
        if chosen and not any(word in name for word in chosen):
            continue
        asked += 1
        offset = text.index(CURSOR)
        before = text[:offset]
        column = len(before[before.rfind("\n") + 1:].encode("utf-16-le")) // 2
        position = {"line": before.count("\n"), "character": column}
        server.tell("textDocument/didChange", {
            "textDocument": {**document, "version": version},
            "contentChanges": [{"text": text.replace(CURSOR, "")}]})
        answer = server.ask(f"textDocument/{request}", {
            "textDocument": document, "position": position, **EXTRA.get(request, {})})
        found = readable(request, answer)
        missing = [word for word in wanted if not stands(request, word, found)]
        extra = [word for word in unwanted if stands(request, word, found)]
        double = request == "hover" and found.count("Equations of motion") > 1
        verdict = "failed" if missing or extra or double else "ok"
        failed += verdict == "failed"
        print(f"{verdict:6} {request}: {name}", f"missing {missing}" if missing else "",
              f"extra {extra}" if extra else "", "equations more than once" if double else "")
        if show or verdict == "failed":
            print("    " + "\n    ".join(found.splitlines()))
    server.process.kill()
    print(f"{asked - failed} of {asked} checks hold")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
