"""The files that reports are written to: checked before the first case is played, so that no run is lost."""

from pathlib import Path

_KINDS = {  # what a file begins with → what it is worth more than a report as
    b"\x89MCAP0": "a recording",
    b"SQLite format 3": "a database",
    b"<argos-configuration": "a scene",
}
_SPACE = b" \t\r\n"


class WrongOutput(Exception):
    """A sentence that names the option and what to write instead."""


def _without_prologue(head: bytes) -> bytes:
    """What follows the mark of UTF-8, the declaration and the comments of XML."""
    head = head.removeprefix(b"\xef\xbb\xbf").lstrip(_SPACE)
    while head.startswith((b"<?", b"<!--")):
        _, separator, rest = head.partition(b"?>" if head.startswith(b"<?") else b"-->")
        if not separator:
            break
        head = rest.lstrip(_SPACE)
    return head


def _kind_of(path: Path) -> str:
    """ "" if there is no file, or it may be replaced."""
    if not path.is_file():
        return ""
    with path.open("rb") as file:
        head = _without_prologue(file.read(16384))
    return next((kind for begin, kind in _KINDS.items() if head.startswith(begin)), "")


def _check_one(option: str, path: Path, ending: str) -> None:
    if path.is_dir():
        raise WrongOutput(f"{option} is '{path}', a folder; name a file in it")
    if not path.exists() and not path.parent.is_dir():
        raise WrongOutput(f"{option} is '{path}', whose folder is not there; make it first")
    if path.suffix != ending and not (path.exists() and not path.is_file()):  # pipes and devices need none
        raise WrongOutput(f"{option} is '{path}'; its name must end with {ending}, because that is the format "
                          "of its content")
    kind = _kind_of(path)
    if kind:
        raise WrongOutput(f"{option} is '{path}', {kind}, which it would replace; name another file")


def check(outputs: list) -> None:
    """outputs: (option, path, ending) of each report that is asked for.
    Raises WrongOutput."""
    for option, path, ending in outputs:
        try:
            _check_one(option, path, ending)
        except OSError as error:
            raise WrongOutput(f"{option} is '{path}': {error.strerror}") from None
