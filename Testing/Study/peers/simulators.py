"""How each program of others is asked for a scene's signals.

A simulator has a name, the package whose version counts, the scenes that it can do, the devices that it runs on (cpu,
cuda), and `settings(scene)`: pairs of words and a function without arguments, whose time is measured and which returns
(signals as transmits x elements x samples, sampling MHz, time of the first sample us), in the host's memory.
"""
import contextlib
import io

import numpy as np

SPEED = 1540.0  # m/s


def with_numpy_2(numpy):
    numpy.concat = getattr(numpy, "concat", numpy.concatenate)


def padded(rf):
    """Signals of each transmit, elements x samples, as one array: zeros behind the shorter ones."""
    longest = max(signals.shape[1] for signals in rf)
    return np.array([np.pad(signals, ((0, 0), (0, longest - signals.shape[1]))) for signals in rf])


class Simulator:
    devices = ("cpu",)

    def __init__(self, device):
        """JAX_PLATFORMS must name the same device: those that run by JAX go by it."""
        self.device = device


class PyMust(Simulator):
    name, package, scenes = "PyMUST", "PyMUST", ("plane", "lens")

    def settings(self, scene):
        with_numpy_2(np)
        import logging
        logging.disable(logging.WARNING)
        import pymust
        param = pymust.utils.Param()
        param.fc, param.fs = 1e6 * scene["centre"], 1e6 * scene["sampling"]
        param.bandwidth, param.c, param.radius = 100 * scene["bandwidth"], SPEED, np.inf
        param.Nelements = len(scene["elementX"])
        param.pitch = 1e-3 * (scene["elementX"][1] - scene["elementX"][0])
        param.width = 1e-3 * scene["width"]
        param.kerf = param.pitch - param.width
        lens = scene["lens"] > 0
        if lens:
            param.height, param.focus = 1e-3 * scene["height"], 1e-3 * scene["lens"]
        points = np.array(scene["points"])
        places = [1e-3 * points[:, axis][None] for axis in ((0, 1, 2) if lens else (0, 2))]

        def run(**given):
            options = pymust.utils.Options()
            options.WaitBar = False
            for name, value in given.items():
                options[name] = value
            rf = []
            for delays in scene["delays"]:
                out = pymust.simus(*places, points[:, 3][None], 1e-6 * np.array(delays)[None], param.copy(), options)
                rf.append(out[0].T)
            return padded(rf), scene["sampling"], 0.0

        whole = dict(FullFrequencyDirectivity=True)
        for choice in (dict(), whole) if lens else (dict(), whole, dict(ElementSplitting=2, **whole)):
            words = ", ".join(name if value is True else f"{name} {value}" for name, value in choice.items())
            yield words or "default", lambda choice=choice: run(**choice)


class FastSimus(Simulator):
    name, package, scenes, devices = "FastSIMUS", "FastSIMUS", ("plane",), ("cpu", "cuda")

    def settings(self, scene):
        import jax
        import jax.numpy as jnp
        from fast_simus.simus import simus_compute, simus_precompute
        from fast_simus.transducer_params import TransducerParams
        pitch = 1e-3 * (scene["elementX"][1] - scene["elementX"][0])
        params = TransducerParams(freq_center=1e6 * scene["centre"], pitch=pitch, n_elements=len(scene["elementX"]),
                                  width=1e-3 * scene["width"], bandwidth=scene["bandwidth"], baffle=scene["baffle"])
        points = np.array(scene["points"], dtype=np.float32)
        places, amplitude = jnp.asarray(1e-3 * points[:, [0, 2]]), jnp.asarray(points[:, 3])
        delays = [jnp.asarray(1e-6 * np.array(d), dtype=jnp.float32) for d in scene["delays"]]
        fs = 1e6 * scene["sampling"]
        choices = [("default", dict(), False, None), ("full_frequency_directivity", dict(), True, None),
                   ("full_frequency_directivity, db_thresh -100", dict(db_thresh=-100), True, None)]
        if self.device == "cuda":
            # A GPU's matrix products are of 10 bits unless more is asked for.
            choices += [(words + ", products in full precision", plan_of, full, "highest")
                        for words, plan_of, full, _ in choices[1:]]
        for words, plan_of, full, precision in choices:
            compiled = {}

            def run(plan_of=plan_of, full=full, precision=precision, compiled=compiled):
                rf = []
                for n, d in enumerate(delays):
                    if n not in compiled:
                        plan = simus_precompute(places, amplitude, d, params, fs=fs, **plan_of)
                        compiled[n] = jax.jit(lambda places, amplitude, d, plan=plan: simus_compute(
                            places, amplitude, d, plan, params, full_frequency_directivity=full).rf)
                    with jax.default_matmul_precision(precision):
                        rf.append(np.asarray(compiled[n](places, amplitude, d)).T)
                return padded(rf), scene["sampling"], 0.0
            yield words + " (compiled before)", run
        if self.device == "cuda":
            yield "its own kernel, by CuPy (compiled before)", self._kernel(scene, params, points, fs)

    def _kernel(self, scene, params, points, fs):
        """It knows the directivity of one frequency alone."""
        import cupy
        from fast_simus.simus import simus_compute, simus_precompute
        places, amplitude = cupy.asarray(1e-3 * points[:, [0, 2]]), cupy.asarray(points[:, 3])
        delays = [cupy.asarray(1e-6 * np.array(d), dtype=cupy.float32) for d in scene["delays"]]
        plans = {}

        def run():
            rf = []
            for n, d in enumerate(delays):
                if n not in plans:
                    plans[n] = simus_precompute(places, amplitude, d, params, fs=fs)
                rf.append(cupy.asnumpy(simus_compute(places, amplitude, d, plans[n], params).rf).T)
            return padded(rf), scene["sampling"], 0.0
        return run


class Zea(Simulator):
    name, package, scenes, devices = "zea", "zea", ("array",), ("cpu", "cuda")

    def settings(self, scene):
        import jax
        from zea.simulator import simulate_rf
        from zea.simulator_time_domain import simulate_rf_td
        points = np.array(scene["points"], dtype=np.float32)
        elements = np.array(scene["elementX"], dtype=np.float32)
        delays = 1e-6 * np.array(scene["delays"], dtype=np.float32)
        longest = 2 * np.hypot(points[:, 0].max() + elements.max(), points[:, 2].max()) / 1.54 + 1e6 * delays.max() + 4
        for words, simulate, times, exponent in (("time domain", simulate_rf_td, 1, 0.0),
                                                 ("time domain, sampled 4 times as often", simulate_rf_td, 4, 0.0),
                                                 ("frequency domain", simulate_rf, 1, 0.0)):
            sampling = times * scene["sampling"]
            given = dict(probe_geometry=np.stack([1e-3 * elements, 0 * elements, 0 * elements], axis=1),
                         apply_lens_correction=False, lens_thickness=1e-3, lens_sound_speed=1000.0, sound_speed=SPEED,
                         n_ax=int(longest * sampling), center_frequency=1e6 * scene["centre"],
                         sampling_frequency=1e6 * sampling, t0_delays=delays, initial_times=np.zeros(len(delays)),
                         element_width=1e-3 * scene["width"], element_height=1e-3 * scene["height"],
                         attenuation_coef=0.0, tx_apodizations=np.ones_like(delays),
                         t_peak=np.full(len(delays), 2e-6 / scene["centre"]), scatter_exponent=exponent)
            compiled = jax.jit(lambda places, amplitude, simulate=simulate, given=given: simulate(
                places, amplitude, **given))
            places = 1e-3 * points[:, :3]

            def run(compiled=compiled, sampling=sampling):
                rf = np.asarray(compiled(places, points[:, 3]))[..., 0]
                return np.swapaxes(rf, 1, 2), sampling, -2 / scene["centre"]
            yield words + " (compiled before)", run


class Esdiva(Simulator):
    name, package, scenes = "eSDIva", "esdiva", ("array",)

    def settings(self, scene):
        import esdiva
        from reference import pulse_of
        spectrum = pulse_of(scene)
        points = np.array(scene["points"])
        pitch = scene["elementX"][1] - scene["elementX"][0]

        def run(along, times, method):
            sampling = times * scene["sampling"]
            half = round(4 / scene["centre"] * sampling)
            t = np.arange(-half, half + 1) / sampling
            f = np.linspace(0, 4 * scene["centre"], 4001)
            excitation = (np.exp(-2j * np.pi * t[:, None] * f) * spectrum(f)).real.sum(axis=1)
            with contextlib.redirect_stdout(io.StringIO()):
                probes = [esdiva.transducers.LinearArrayTransducer(
                    n_elements=len(scene["elementX"]), element_width_mm=scene["width"],
                    element_height_mm=scene["height"], kerf_mm=pitch - scene["width"], no_sub_x=along, no_sub_y=1,
                    frequency_Hz=1e6 * scene["centre"]) for _ in range(2)]
                reception = esdiva.Reception(*probes, c=SPEED, fs=1e6 * sampling, excitation=excitation, method=method,
                                             verbose=False)
                rf, coords = reception.sequence_rf(points[:, :3], points[:, 3],
                                                   [dict(delays=1e-6 * np.array(d)) for d in scene["delays"]])
            return rf, sampling, 1e6 * coords["t0_per_event"] + np.max(scene["delays"], axis=1)

        for along, times, method in ((1, 1, "spectral"), (1, 2, "spectral"), (2, 2, "spectral"), (1, 8, "temporal")):
            yield (f"{method}, {along} x 1 patches, {times} times the sampling",
                   lambda given=(along, times, method): run(*given))


class KWave(Simulator):
    """Solves waves on a grid; the echo is what a run with points hears less what one without does, of which the first is
    timed. Points are a node each, so weak that none hears another. Its solver in Python, on a GPU by CuPy: the package
    would fetch programs when it is imported, which a study of fixed versions doesn't want."""
    name, package, scenes, devices = "k-Wave", "k-Wave-python", ("waves",), ("cpu", "cuda")

    def settings(self, scene):
        import logging
        import urllib.request

        def refuse(*_):
            raise TimeoutError
        logging.disable(logging.WARNING)
        urllib.request.urlretrieve = refuse
        from kwave.kgrid import kWaveGrid
        from kwave.kmedium import kWaveMedium
        from kwave.ksensor import kSensor
        from kwave.ksource import kSource
        from kwave.kspaceFirstOrder import kspaceFirstOrder
        points, elements = np.array(scene["points"]), np.array(scene["elementX"])
        deepest, widest = points[:, 2].max(), max(np.abs(points[:, 0]).max(), elements.max())
        lead = 6 * scene["deviation"]
        duration = 2 * np.hypot(deepest, 2 * widest) / 1.54 + np.max(scene["delays"]) + 2 * lead
        without = {}

        def run(step, courant):
            x0, z0 = -widest - 1.2, -0.9
            # Places are in the middle between multiples of 0.3 mm; node numbers are whole.
            node = lambda x, z: (np.rint((x - first) / step).astype(int), np.rint((z - z0) / step).astype(int))
            first = elements[0] - step * np.ceil((elements[0] - x0) / step)
            size = node(np.array([widest + 1.2]), np.array([deepest + 0.9]))
            grid = kWaveGrid([int(size[0][0]) + 1, int(size[1][0]) + 1], [1e-3 * step] * 2)
            dt = courant * step / 1.54
            grid.setTime(int(duration / dt), 1e-6 * dt)
            t = dt * np.arange(grid.Nt)[None] - np.array(scene["delays"][0])[:, None] - lead
            mask = np.zeros(tuple(grid.N))
            mask[node(elements, 0 * elements)] = 1
            source, sensor = kSource(), kSensor(mask=mask, record=["p"])
            source.p_mask, source.p_mode = mask, "additive"
            source.p = np.exp(-0.5 * (t / scene["deviation"]) ** 2) * np.cos(2 * np.pi * scene["centre"] * t)
            speed = np.full(tuple(grid.N), SPEED)

            def solve():
                device = "gpu" if self.device == "cuda" else "cpu"
                return np.asarray(kspaceFirstOrder(grid, kWaveMedium(sound_speed=speed, density=1000.0), source, sensor,
                                                   quiet=True, pml_size=20, device=device)["p"])
            if (step, courant) not in without:
                without[step, courant] = solve()
            speed[node(points[:, 0], points[:, 2])] = SPEED / np.sqrt(1 + 2e-5 * points[:, 3] / step ** 2)
            return lambda: ((solve() - without[step, courant])[None], 1 / dt, -lead)

        # The finest would take a CPU minutes a call.
        for step, courant in ((0.15, 0.3), (0.1, 0.3), (0.05, 0.3))[:3 if self.device == "cuda" else 2]:
            yield f"grid of {step} mm, CFL {courant}", run(step, courant)
