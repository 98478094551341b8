"""The two ways in which the laboratory refuses: a wrong call, and work that failed."""


class LabError(Exception):
    """One line for the user: what failed, where, and what to do. Exit code 1."""

    code = 1


class WrongCall(LabError):
    """A call that cannot be carried out as it is written. Exit code 2."""

    code = 2
