"""SonoVDB in Python: its VTK filters (sonovdb.vtkSonoFilters) and data sets to learn from (Dataset, write_shards)."""

__all__ = ["Dataset", "write_shards"]


def __getattr__(name):
    """Late, so that the filters alone need no NumPy."""
    if name in __all__:
        from . import datasets
        return getattr(datasets, name)
    raise AttributeError(f"module 'sonovdb' has no attribute '{name}'")
