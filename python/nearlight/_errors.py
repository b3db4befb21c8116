# SPDX-License-Identifier: Apache-2.0
"""The exceptions of nearlight."""

from typing import Any


class Error(Exception):
    """What the library could not do. The text is one line: what failed, on what, and what to do.

    kind: 'failure', 'invalid_argument', 'file', 'no_device', 'kernel_build' or 'out_of_memory'.
    setting: the setting to change, such as 'width'; '' if no single one is to blame.
    exit_code: what the program `nearlight` returns for this kind.
    """

    def __init__(self, message: str, kind: str = "failure", setting: str = "", exit_code: int = 1) -> None:
        super().__init__(message)
        self.kind = kind
        self.setting = setting
        self.exit_code = exit_code

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (*self.args, self.kind, self.setting, self.exit_code)


class InvalidArgument(Error, ValueError):
    """An Error whose kind is 'invalid_argument': a value that a function does not take."""
