"""Where the chunks of a campaign are computed: threads, processes, or the workers of a Dask cluster."""

import logging
import os
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from importlib.util import find_spec
from multiprocessing import get_context

from wspd_design.parameters.errors import UserError

EXECUTORS = ("threads", "processes", "dask")
CLUSTER_INSTALLATION = 'pip install "wspd-design[cluster]"'
_CONNECT = 30  # s, until a scheduler that does not answer is given up


@contextmanager
def executor(kind: str, *, workers: int | None, scheduler: str | None) -> Iterator[Executor]:
    """Open an executor for a campaign.

    Parameters
    ----------
    kind : {"threads", "processes", "dask"}
        Threads are enough on one machine: the compiled loop lets them run at the same time.
    workers : int or None
        Their number; that of the cores by default.
    scheduler : str or None
        Address of a Dask scheduler; without one a cluster is started on this machine.
    """
    if kind not in EXECUTORS:
        raise UserError(f'unknown executor "{kind}"; available: {", ".join(EXECUTORS)}')
    if scheduler is not None and kind != "dask":
        raise UserError(f"--scheduler is about Dask; add --executor dask, or leave it out for {kind}")
    if scheduler is not None and workers is not None:
        raise UserError(
            "--workers is about this machine; the workers of a scheduler are started beside it, by dask worker ADDRESS"
        )
    if kind == "threads":
        with ThreadPoolExecutor(workers or os.cpu_count()) as threads:
            yield threads
    elif kind == "processes":
        with ProcessPoolExecutor(
            workers or os.cpu_count(), mp_context=get_context("spawn"), initializer=_leave_interrupts
        ) as processes:
            yield processes
    else:
        with _dask(workers, scheduler) as cluster:
            yield cluster


def _leave_interrupts() -> None:
    """Let Ctrl-C end the campaign, which then ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _dask(workers: int | None, scheduler: str | None) -> Iterator[Executor]:
    if find_spec("distributed") is None:
        raise UserError(f"--executor dask needs Dask, which is not installed: {CLUSTER_INSTALLATION}")
    from distributed import Client, LocalCluster

    logging.getLogger("distributed").setLevel(
        logging.CRITICAL
    )  # workers that go are its matter, not an error
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=_CONNECT)
        except (OSError, ValueError) as error:
            raise UserError(
                f"no Dask scheduler answers at {scheduler} ({error}); start one by dask scheduler and workers by "
                "dask worker ADDRESS"
            ) from None
        with client:
            yield client.get_executor(pure=False)
        return
    with (
        LocalCluster(
            n_workers=workers or os.cpu_count(),
            threads_per_worker=1,
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client.get_executor(pure=False)
