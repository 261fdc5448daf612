"""Calls of CasADi's virtual machine that convert nothing."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Bound:
    """A CasADi function on fixed memory: a call then costs no conversion."""

    def __init__(self, function: Any, *inputs: "Array") -> None:
        import numpy as np

        # The outputs have one row per column of the function's.
        self.outputs = [np.zeros(function.size_out(k)[::-1]) for k in range(function.n_out())]
        self.buffer, self.call = function.buffer()  # the buffer has to live as long as the call
        for k, array in enumerate(inputs):
            self.buffer.set_arg(k, array.data)
        for k, array in enumerate(self.outputs):
            self.buffer.set_res(k, array.data)
