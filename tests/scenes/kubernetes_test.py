# SPDX-License-Identifier: MIT
"""`ziggurat sweep --kubernetes`: the manifest against the published schema of Kubernetes, as the models of its
Python client have it, which are generated from that schema. No cluster runs it here."""

import unittest

import yaml
from kubernetes import client

from harness import FAULT, main
from sweep_test import SweepTest

PRIMITIVES = {"str": str, "int": int, "bool": bool, "float": (int, float), "object": object}


def faults(value, kind, where):
    """How a value differs from a type of the schema: unknown fields, wrong types, missing required fields."""
    if kind.startswith("list["):
        if not isinstance(value, list):
            return [f"{where}: must be a list"]
        return [fault for i, each in enumerate(value) for fault in faults(each, kind[5:-1], f"{where}[{i}]")]
    if kind.startswith("dict("):
        if not isinstance(value, dict):
            return [f"{where}: must be an object"]
        inner = kind[5:-1].partition(", ")[2]
        return [fault for key, each in value.items() for fault in faults(each, inner, f"{where}.{key}")]
    if kind in PRIMITIVES:
        good = isinstance(value, PRIMITIVES[kind]) and not (kind == "int" and isinstance(value, bool))
        return [] if good else [f"{where}: must be {kind}, is {value!r}"]
    model = getattr(client, kind)
    if not isinstance(value, dict):
        return [f"{where}: must be an object ({kind})"]
    known = {name: field for field, name in model.attribute_map.items()}
    found = [f"{where}.{key}: {kind} has no such field" for key in value if key not in known]
    for key, each in value.items():
        if key in known:
            found += faults(each, model.openapi_types[known[key]], f"{where}.{key}")
    if not found:
        try:  # the constructors check which fields are required
            model(**{known[key]: object() for key in value})
        except ValueError as error:
            found.append(f"{where}: {error}")
    return found


class Kubernetes(SweepTest):
    def manifest(self, *arguments):
        file = self.folder / "job.yaml"
        self.sweep(self.scene, *self.grid[:-2], "--kubernetes", file, "--image", "example.org/ziggurat:1", "--claim",
                   "data", "--mount", self.folder, *arguments)
        return yaml.safe_load(file.read_text())

    def test_keeps_to_the_schema(self):
        job = self.manifest("--chunk", "5", "--timeout", "60")
        self.assertEqual(faults(job, "V1Job", "job"), [])
        self.assertEqual((job["apiVersion"], job["kind"]), ("batch/v1", "Job"))
        spec = job["spec"]
        self.assertEqual((spec["completionMode"], spec["completions"], spec["parallelism"]), ("Indexed", 3, 3))
        container = spec["template"]["spec"]["containers"][0]
        self.assertEqual(container["command"][:4], ["ziggurat", "sweep", "task", str(self.out)])
        self.assertEqual(spec["template"]["spec"]["restartPolicy"], "OnFailure")

    def test_the_check_finds_faults(self):
        job = self.manifest()
        for change, words in (
                (lambda: job["spec"].update(complitions=3), "complitions: V1JobSpec has no such field"),
                (lambda: job["spec"].update(completions="3"), "completions: must be int"),
                (lambda: job["spec"].pop("template"), "template"),
                (lambda: job.update(spec=[]), "must be an object")):
            job = self.manifest()
            change()
            self.assertIn(words, "\n".join(faults(job, "V1Job", "job")))

    def test_its_tasks_make_the_table(self):
        job = self.manifest("--chunk", "5")
        command = job["spec"]["template"]["spec"]["containers"][0]["command"]
        for index in range(job["spec"]["completions"]):
            self.environment["JOB_COMPLETION_INDEX"] = str(index)
            outcome = self.ziggurat(*command[1:])
            self.assertEqual(outcome.code, 0, outcome.err)
        self.sweep("results", self.out, out=False)
        self.assert_whole(12)
        here = self.folder / "here"
        self.sweep(self.scene, *self.grid, out=here)
        self.assertEqual(self.rows(), self.rows(here))

    def test_needs_what_containers_see(self):
        for arguments, pattern in ((("--kubernetes", "a.yaml"), "--kubernetes needs --image"),
                                   (("--image", "x"), "--image needs --kubernetes"),
                                   (("--kubernetes", "a.yaml", "--image", "x", "--claim", "y", "--mount", "/data"),
                                    "is not below --mount /data")):
            outcome = self.sweep(self.scene, *self.grid, *arguments, code=FAULT)
            self.assert_is_sentence(outcome, pattern)


if __name__ == "__main__":
    main()
