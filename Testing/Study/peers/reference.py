"""What a scene of points must sound like: a direct sum in double precision, and how far signals lie from it.

A scene is a dict as Peers.cpp writes it. Everything in mm, MHz, us, time as exp(-2 pi i f t).
"""
import concurrent.futures
import os

import numpy as np

SPEED = 1.54  # mm/us


def hann_pulse(centre, periods=4):
    """A cosine under a Hann window of so many periods, which zea sends: its spectrum."""
    length = periods / centre

    def spectrum(f):
        t = np.linspace(-length / 2, length / 2, 4001)
        p = 0.5 * (1 + np.cos(2 * np.pi * t / length)) * np.cos(2 * np.pi * centre * t)
        return np.array([np.trapezoid(p * np.exp(2j * np.pi * g * t), t) if hasattr(np, "trapezoid") else
                         np.trapz(p * np.exp(2j * np.pi * g * t), t) for g in f])
    return spectrum


def simus_pulse(centre, bandwidth):
    """The windowed sine of SIMUS through its transducer, there and back (Garcia 2022); nothing above twice the centre."""
    power = np.log(126) / np.log(2 / bandwidth)
    width = bandwidth * centre / 2 / np.log(2) ** (1 / power)

    def spectrum(f):
        f = np.asarray(f, dtype=float)
        sent = 1j * (np.sinc((f - centre) / centre) - np.sinc((f + centre) / centre))
        return np.where(f <= 2 * centre, sent * np.exp(-(np.abs(f - centre) / width) ** power), 0)
    return spectrum


def burst(centre, deviation):
    """A Gaussian burst of so long a standard deviation."""
    return lambda f: np.exp(-0.5 * (2 * np.pi * deviation * (np.asarray(f) - centre)) ** 2) + 0j


def kwave_scattering(f):
    """What two-dimensional waves add to a source's signal: a source of mass (omega H0 / 4), a point that is softer than
    its surroundings (k^2 i H0 / 4)."""
    return 1j * np.asarray(f, dtype=float) ** 3


def pulse_of(scene):
    """The spectrum of a scene's pulse as the reference has it."""
    if scene["pulse"] == "simus":
        return simus_pulse(scene["centre"], scene["bandwidth"])
    if scene["pulse"] == "hann":
        return hann_pulse(scene["centre"])
    sent = burst(scene["centre"], scene["deviation"])
    return lambda f: sent(f) * kwave_scattering(f)


def pulse_for_us(scene):
    """The same as we take it: of waves in two dimensions we know r^-1/2 exp(ikr) alone, so each way's factor
    sqrt(2 / (pi k)) exp(-i pi / 4) is the pulse's."""
    spectrum = pulse_of(scene)
    if scene["waves"] != "cylinder":
        return spectrum
    return lambda f: spectrum(f) * -1j / np.maximum(np.asarray(f, dtype=float), 1e-9)


def pulse_samples(scene):
    """Times and amplitudes of the pulse for us, peak 1."""
    spectrum = pulse_for_us(scene)
    f = np.linspace(0, 4 * scene["centre"], 8001)
    t = np.arange(-600, 601) * 0.02 / scene["centre"]
    p = (spectrum(f) * np.exp(-2j * np.pi * t[:, None] * f)).real.sum(axis=1)
    return t, p / np.abs(p).max()


class Spectrum:
    """What each element hears of each transmit over the frequencies that matter."""

    def __init__(self, scene, points, nodes=1, elements=None):
        self.scene = scene
        places = np.array(points)
        x, y, z, amplitude = places.T
        elementX = np.array(scene["elementX"])
        self.delays = np.array(scene["delays"])
        pulse = pulse_of(scene)
        far = np.hypot(np.abs(x)[:, None] + np.abs(elementX).max(), z[:, None]).max()
        self.length = 2 * far / SPEED + self.delays.max() + 12 / scene["centre"]
        step = 1 / self.length
        f = step * np.arange(1, int(4 * scene["centre"] / step))
        size = np.abs(pulse(f))
        self.f = f[size > 1e-6 * size.max()]
        self.f = step * np.arange(round(self.f[0] / step), round(self.f[-1] / step) + 1)
        self.step = step
        heard = range(len(elementX)) if elements is None else elements
        self.values = np.zeros((len(self.delays), len(heard), len(self.f)), dtype=complex)
        ways = [self._ways(x, y, z, e, nodes) for e in elementX]
        chunk = 64
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for first in range(0, len(self.f), chunk):
                f = self.f[first:first + chunk]
                response = np.stack(list(pool.map(lambda way: self._response(way, f), ways)))
                for t, delays in enumerate(self.delays):
                    sent = np.exp(2j * np.pi * delays[:, None] * f)
                    arrived = np.einsum("ef,efs->fs", sent, response) * amplitude * pulse(f)[:, None]
                    self.values[t, :, first:first + chunk] = np.einsum("efs,fs->ef", response[list(heard)], arrived)

    def _ways(self, x, y, z, elementX, nodes):
        """Lengths, with the lens's, and weights of the pieces of an element: points x pieces."""
        scene = self.scene
        u, wu = np.polynomial.legendre.leggauss(scene["nodesAlong"] * nodes)
        alongs = elementX + 0.5 * scene["width"] * u
        if scene["waves"] == "sphere":
            v, wv = np.polynomial.legendre.leggauss(scene["nodesAcross"] * nodes)
        else:
            v, wv = np.zeros(1), np.full(1, 2.0)
        across = 0.5 * scene["height"] * v
        weight = (0.25 * wu[:, None] * wv).ravel()
        a, b = (m.ravel() for m in np.meshgrid(alongs, across, indexing="ij"))
        r = np.sqrt((x[:, None] - a) ** 2 + (y[:, None] - b) ** 2 + z[:, None] ** 2)
        if scene["baffle"] == "soft":
            weight = weight * z[:, None] / r
        lens = b ** 2 / (2 * scene["lens"]) if scene["lens"] > 0 else 0
        if scene["waves"] == "cylinder":
            return r - lens, r, weight + 0 * r
        return r - lens, None, weight / (r if scene["waves"] == "sphere" else np.sqrt(r))

    def _response(self, way, f):
        """Frequencies x points."""
        length, range_, weight = way
        if range_ is not None:
            from scipy.special import hankel1
            k = 2 * np.pi * f / SPEED
            return (hankel1(0, k[:, None, None] * range_) * weight).sum(axis=-1)
        wave = weight * np.exp(2j * np.pi * f[0] / SPEED * length)
        step = np.exp(2j * np.pi * self.step / SPEED * length)
        out = np.empty((len(f), len(length)), dtype=complex)
        for n in range(len(f)):
            np.sum(wave, axis=1, out=out[n])
            wave *= step
        return out

    def signals(self, transmit, times, shift=0.0):
        """Elements x times of a transmit, and their derivative by a later arrival."""
        turn = np.exp(-2j * np.pi * np.outer(self.f, times - shift)) * 2 * self.step
        values = self.values[transmit]
        return (values @ turn).real, (values * (2j * np.pi * self.f) @ turn).real


def in_time(scene, points, elements, times, along=24, across=48):
    """The second way: no frequencies. Each pair of pieces of a sending and a hearing element, at midpoints instead of
    Gauss's nodes, echoes at its own time; what arrives at each time is gathered in fine bins and echoes the pulse."""
    spectrum = pulse_of(scene)
    bin_ = 1e-3 / scene["centre"]
    f = np.linspace(0, 4 * scene["centre"], 6001)
    half = 12000
    fine = bin_ * np.arange(-half, half + 1)
    pulse = np.zeros(len(fine))
    for first in range(0, len(f), 500):
        g = f[first:first + 500]
        pulse += 2 * (f[1] - f[0]) * (np.exp(-2j * np.pi * np.outer(fine, g)) @ spectrum(g)).real
    delays = np.array(scene["delays"])
    x, y, z, amplitude = np.array(points).T
    count = (along, across if scene["waves"] == "sphere" else 1)
    a = ((np.arange(count[0]) + 0.5) / count[0] - 0.5) * scene["width"]
    b = ((np.arange(count[1]) + 0.5) / count[1] - 0.5) * scene["height"] if count[1] > 1 else np.zeros(1)
    a, b = (m.ravel() for m in np.meshgrid(a, b, indexing="ij"))
    power = 1.0 if scene["waves"] == "sphere" else 0.5
    lens = b ** 2 / (2 * scene["lens"]) if scene["lens"] > 0 else 0 * b
    elementX = np.array(scene["elementX"])
    r = np.sqrt((x[:, None, None] - elementX[:, None] - a) ** 2 + (y[:, None, None] - b) ** 2 + z[:, None, None] ** 2)
    size = r ** -power / len(a)
    if scene["baffle"] == "soft":
        size *= z[:, None, None] / r
    late = (r - lens) / SPEED
    out = np.zeros((len(delays), len(elements), len(times)))
    for s in range(len(x)):
        for t in range(len(delays)):
            first, sent = gathered((delays[t][:, None] + late[s]).ravel(), size[s].ravel(), bin_)
            used = np.nonzero(sent)[0]
            for n, e in enumerate(elements):
                both = first + bin_ * used[:, None] + late[s, e]
                start, heard = gathered(both.ravel(), (sent[used][:, None] * size[s, e]).ravel(), bin_)
                when = start + bin_ * np.arange(len(heard))
                for i in np.nonzero((times > when[0] - fine[-1]) & (times < when[-1] + fine[-1]))[0]:
                    out[t, n, i] += amplitude[s] * np.dot(heard, np.interp(times[i] - when, fine, pulse, 0, 0))
    return out


def gathered(times, sizes, bin_):
    """The first time, and sizes in bins, each split between its neighbours."""
    first = times.min()
    place = (times - first) / bin_
    index = place.astype(int)
    share = place - index
    out = np.bincount(index, sizes * (1 - share), minlength=index.max() + 2)
    out[1:] += np.bincount(index, sizes * share, minlength=index.max() + 1)[:index.max() + 1]
    return first, out


def difference(spectrum, rf, sampling, start=0.0):
    """Relative root mean square of what is left of signals (transmits x elements x samples) less the reference, after
    one factor for each transmit and one delay (us) for all: (error, delay). `start` is the time of the first sample, or
    of each transmit's."""
    starts = np.broadcast_to(start, len(rf))
    shift = 0.0
    for _ in range(6):
        moves, sizes, left = [], [], 0.0
        for t, signal in enumerate(np.asarray(rf, dtype=float)):
            times = starts[t] + np.arange(signal.shape[-1]) / sampling
            inside = (times >= 0) & (times < spectrum.length)
            expected, slope = (values.ravel() for values in spectrum.signals(t, times[inside], shift))
            heard = signal[:, inside].ravel()
            (factor, moved), *_ = np.linalg.lstsq(np.stack([expected, slope], axis=1), heard, rcond=None)
            moves.append(moved / factor)
            sizes.append(np.sum(expected ** 2))
            left += np.sum((heard / (np.vdot(expected, heard) / sizes[-1]) - expected) ** 2)
        error = np.sqrt(left / np.sum(sizes))
        move = np.average(moves, weights=sizes)
        if abs(move) < 1e-7:
            break
        shift += np.clip(move, -0.05, 0.05)
    return float(error), float(shift)
