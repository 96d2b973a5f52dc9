# SPDX-License-Identifier: MPL-2.0
"""The commands of tools/release: see there."""

import argparse
import gzip
import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from collections.abc import Iterator
from datetime import UTC, date, datetime
from email.utils import format_datetime
from pathlib import Path
from uuid import NAMESPACE_URL, uuid5
from zipfile import ZipFile

ROOT = Path(__file__).resolve().parent.parent
NUMBER = r"\d+\.\d+\.\d+"
# Every file that states the version, and the text around it; CMakeLists.txt decides, the others may be absent.
STATED = {
    "CMakeLists.txt": rf"(?m)^(project\(revchain VERSION )({NUMBER})",
    "CITATION.cff": rf"(?m)^(version: )({NUMBER})$",
    "packaging/conda/recipe.yaml": rf'(?m)^(  version: ")({NUMBER})',
    "packaging/vcpkg/revchain/vcpkg.json": rf'(?m)^(  "version": ")({NUMBER})',
    "docs/howto/cmake.md": rf"(revchain-)({NUMBER})(?=-source\.tar\.gz)",
    "docs/install.md": rf"(revchain-)({NUMBER})(?=-FILE\.whl)",
    "debian/changelog": rf"\A(revchain \()({NUMBER})",
}


class Refused(Exception):
    """The release cannot be made. The message has one line for each problem."""


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def version_of(root: Path) -> str:
    if not (stated := re.search(STATED["CMakeLists.txt"], read(root / "CMakeLists.txt"))):
        raise Refused("CMakeLists.txt: has no version. Write: project(revchain VERSION X.Y.Z)")
    return stated[2]


def release_date(root: Path, version: str) -> date:
    """The date of the section of CHANGELOG.md for the version, which must be the first and must say something."""
    sections = re.split(r"(?m)^## ", read(root / "CHANGELOG.md"))[1:]
    name, _, section = (sections[0] if sections else "").partition("\n")
    found, _, when = name.partition(" ")
    if found != version:
        raise Refused(
            f"CHANGELOG.md: the first section must be that of version {version}, it is {found or 'missing'}. "
            f"Write: ## {version} (YYYY-MM-DD)"
        )
    if not section.strip():
        raise Refused(f"CHANGELOG.md: the section of version {version} is empty. Write what has changed")
    try:
        return date.fromisoformat(when.removeprefix("(").removesuffix(")"))
    except ValueError:
        raise Refused(
            f"CHANGELOG.md: the section of version {version} must have a date, it has {when or 'none'}. "
            f"Write: ## {version} (YYYY-MM-DD)"
        ) from None


def problems(root: Path) -> Iterator[str]:
    version = version_of(root)
    for name, pattern in STATED.items():
        if not (path := root / name).exists():
            continue
        stated = re.search(pattern, read(path))
        if (found := stated[2] if stated else "none") != version:
            yield (
                f"{name}: the version must be {version}, as in CMakeLists.txt, it is {found}. "
                f"Run: tools/release bump {version}"
            )
    try:
        line = f"date-released: {release_date(root, version)}"
        if line not in read(root / "CITATION.cff").splitlines():
            yield f"CITATION.cff: the line '{line}' is missing. Run: tools/release bump {version}"
    except Refused as error:
        yield str(error)


def bump(root: Path, version: str) -> None:
    if not re.fullmatch(NUMBER, version):
        raise Refused(f"the version must be three numbers such as 1.2.3, it is {version}")
    when = release_date(root, version)
    for name, pattern in STATED.items():
        if not (path := root / name).exists():
            continue
        text = read(path)
        if name == "CITATION.cff":
            text = re.sub(r"(?m)^date-released: .*\n", "", text)
            text = re.sub(pattern, rf"\g<1>\g<2>\ndate-released: {when}", text)
        if name == "debian/changelog" and (last := re.search(pattern, text)) and last[2] != version:
            at = format_datetime(datetime(when.year, when.month, when.day, tzinfo=UTC))
            signed = re.search(r"(?m)^ -- (.*>)  ", text)
            text = (
                f"revchain ({version}) unstable; urgency=medium\n\n  * New version. CHANGELOG.md lists the changes.\n\n"
                f" -- {signed[1] if signed else 'The revchain developers'}  {at}\n\n{text}"
            )
        path.write_text(re.sub(pattern, rf"\g<1>{version}", text, count=1), encoding="utf-8")


def sbom(root: Path, gsl: str, when: datetime) -> str:
    """The bill of materials in CycloneDX 1.6: what the wheel contains, and what pip installs beside it."""
    from cyclonedx.model import Property
    from cyclonedx.model.bom import Bom
    from cyclonedx.model.component import Component, ComponentScope, ComponentType
    from cyclonedx.model.license import LicenseExpression
    from cyclonedx.output.json import JsonV1Dot6
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator
    from packageurl import PackageURL

    def component(kind: str, name: str, version: str | None, licence: str | None, **more: object) -> Component:
        purl = PackageURL(kind, None, name, version)
        licences = [LicenseExpression(licence)] if licence else []
        return Component(name=name, version=version, purl=purl, bom_ref=str(purl), licenses=licences, **more)

    pins = dict(re.findall(r"(?m)^([\w-]+)==(\S+)$", read(root / "tools/build_constraints.txt")))
    viewer = json.loads(read(root / "src/revchain/motion/viewer/package.json"))["dependencies"]
    project = tomllib.loads(read(root / "pyproject.toml"))["project"]
    itself = component("pypi", "revchain", version_of(root), project["license"], description=project["description"])
    contained = [
        component("generic", "gsl", gsl, "GPL-3.0-or-later", description="GNU Scientific Library, linked statically"),
        component("pypi", "cmeel-eigen", pins["cmeel-eigen"], "MPL-2.0", description="Eigen, compiled in"),
        component("pypi", "pybind11", pins["pybind11"], "BSD-3-Clause", description="compiled in"),
        component("npm", "three", viewer["three"], "MIT", description="three.js, in revchain/motion/viewer.min.js"),
    ]
    installed: dict[str, dict[str, str]] = {}  # name -> extra, '' for none -> versions
    for extra, needs in {"": project["dependencies"], **project["optional-dependencies"]}.items():
        for need in needs:
            name, versions = re.fullmatch(r"([\w.-]+)(?:\[.*\])?(.*)", need).groups()
            if name != "revchain" and extra not in {"docs", "test"}:
                installed.setdefault(name, {})[extra] = versions
    beside = [
        component(
            "pypi", name, None, None, description="installed beside revchain by pip",
            scope=ComponentScope.REQUIRED if "" in extras else ComponentScope.OPTIONAL,
            properties=[Property(name=f"revchain:extra:{e}" if e else "revchain:requires", value=v) for e, v in extras.items()],
        )
        for name, extras in installed.items()
    ]  # fmt: skip
    itself.type = ComponentType.LIBRARY
    bom = Bom(components=[*contained, *beside], serial_number=uuid5(NAMESPACE_URL, str(itself.purl)))
    bom.metadata.component, bom.metadata.timestamp = itself, when
    bom.register_dependency(itself, bom.components)
    text = JsonV1Dot6(bom).output_as_string(indent=1) + "\n"
    if error := JsonStrictValidator(SchemaVersion.V1_6).validate_str(text):
        raise Refused(f"the SBOM does not follow the schema of CycloneDX 1.6: {error}")
    return text


def run(*command: str | Path, where: Path = ROOT, **env: str) -> str:
    print("+", *command, flush=True)
    result = subprocess.run(command, check=False, cwd=where, env=os.environ | env, text=True, stdout=subprocess.PIPE)
    if result.returncode:
        raise Refused(f"{result.stdout}{' '.join(map(str, command))} failed with {result.returncode}")
    return result.stdout


def check() -> None:
    found = list(problems(ROOT))
    if changed := run("git", "status", "--porcelain"):
        found.append(f"the work tree has changes: commit them, or remove them\n{changed}")
    for tool in (["reuse", "lint"], ["cffconvert", "--validate"]):  # each has an environment of its own
        try:
            print(run(sys.executable, "-m", "pipx", "run", *tool))
        except Refused as error:
            found.append(str(error))
    if found:
        raise Refused("\n".join(found))
    print(f"tools/release: version {version_of(ROOT)} checked")


def packages(folder: Path, epoch: str, **env: str) -> Path:
    """The folder dist of a clone in `folder`, with the sdist and the wheel in it."""
    run("git", "clone", "--quiet", ROOT, folder)
    constraints = (folder / "tools/build_constraints.txt").as_uri()  # pip splits paths at spaces
    env |= {"SOURCE_DATE_EPOCH": epoch, "PIP_CONSTRAINT": constraints}
    run(sys.executable, "-m", "build", "--sdist", "--outdir", folder / "dist", folder, **env)
    run(folder / "tools/wheel", where=folder, **env)
    return folder / "dist"


def archive(folder: Path, file: Path, epoch: int) -> None:
    """The folder as .tar.gz with names in order and one time."""

    def plain(member: tarfile.TarInfo) -> tarfile.TarInfo:
        member.mtime, member.uid, member.gid, member.uname, member.gname = epoch, 0, 0, "", ""
        return member

    kept = io.BytesIO()
    with tarfile.open(fileobj=kept, mode="w") as tar:  # add() takes the files of a folder in order
        tar.add(folder, file.name.removesuffix(".tar.gz"), filter=plain)
    file.write_bytes(gzip.compress(kept.getvalue(), mtime=epoch))


def differences(one: Path, other: Path) -> Iterator[str]:
    """Files that differ; of a wheel also which files in it."""
    for name in sorted({path.name for folder in (one, other) for path in folder.iterdir()}):
        a, b = one / name, other / name
        if not (a.exists() and b.exists()):
            yield f"{name} is in one build only"
        elif a.read_bytes() != b.read_bytes():
            yield f"{name} differs"
            if name.endswith(".whl"):
                with ZipFile(a) as left, ZipFile(b) as right:
                    names = {*left.namelist(), *right.namelist()}
                    both = {*left.namelist()} & {*right.namelist()}
                    yield from (f"  {n}" for n in sorted(names) if n not in both or left.read(n) != right.read(n))


def build(twice: bool) -> None:
    check()
    version, epoch = version_of(ROOT), run("git", "log", "-1", "--format=%ct").strip()
    dist = ROOT / "dist"
    shutil.rmtree(dist, ignore_errors=True)
    dist.mkdir()
    with tempfile.TemporaryDirectory() as work:
        first = packages(Path(work) / "first", epoch)
        for path in first.iterdir():
            shutil.copy2(path, dist)
        if twice:
            second = packages(Path(work) / "second of the two", epoch, CCACHE_DISABLE="1")
            if found := list(differences(first, second)):
                raise Refused("the second build is not equal to the first:\n" + "\n".join(found))
            print("equal in both builds:", *sorted(path.name for path in first.iterdir()))
    run("git", "archive", f"--prefix=revchain-{version}/", "-o", dist / f"revchain-{version}-source.tar.gz", "HEAD")
    gsl = run("gsl-config", "--version").strip()
    text = sbom(ROOT, gsl, datetime.fromtimestamp(int(epoch), UTC))
    (dist / f"revchain-{version}.cdx.json").write_text(text, encoding="utf-8")
    run(ROOT / "tools/site")
    archive(ROOT / "out/site", dist / f"revchain-{version}-site.tar.gz", int(epoch))
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in sorted(dist.iterdir())]
    (dist / "SHA256SUMS").write_text("".join(sums), encoding="utf-8")
    print("".join(sums), end="")
    print(f"To publish:\n  git tag -a v{version} -m 'revchain {version}'\n  git push origin v{version}")
    print("  twine upload dist/*.whl " + f"dist/revchain-{version}.tar.gz")


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/release")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("bump").add_argument("version")
    commands.add_parser("check")
    commands.add_parser("build").add_argument("--twice", action="store_true")
    given = parser.parse_args()
    try:
        if given.command == "bump":
            bump(ROOT, given.version)
        elif given.command == "check":
            check()
        else:
            build(given.twice)
    except Refused as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
