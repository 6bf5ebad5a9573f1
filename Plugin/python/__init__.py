"""SonoVDB in Python: its VTK filters (sonovdb.vtkSonoFilters), data sets to learn from (Dataset, write_shards), and the motion
between label maps of a cycle (register_phases)."""

__all__ = ["Dataset", "register_phases", "write_shards"]


def __getattr__(name):
    """Late, so that the filters alone need no NumPy."""
    if name == "register_phases":
        from . import registration
        return registration.register_phases
    if name in __all__:
        from . import datasets
        return getattr(datasets, name)
    raise AttributeError(f"module 'sonovdb' has no attribute '{name}'")
