"""Speed against error on the machine at hand: what is measured, and the page, the rows and the plots made of it.

Once this package is imported it is what `shviewer.report` means, and so it can be called as that function.
"""

import sys
from types import ModuleType


class _Callable(ModuleType):
    def __call__(self, *arguments: object, **named: object) -> object:
        from shviewer.exchange import face

        return face.report(*arguments, **named)  # type: ignore[arg-type]


sys.modules[__name__].__class__ = _Callable
