"""Finds how tissue moves between the label maps of a motion's phases, so that its speckle rides on it:

    pvpython register_phases.py phase_00.nii.gz phase_01.nii.gz ... --out cine
    pvpython register_phases.py beating_heart_4d.nii.gz --out cine

Writes cine/phase_00.vti, ...: the labels with DisplacementMm and MovingLabels. Open them in ParaView as one series; Ultrasound
Scene and Simulate Ultrasound take them as they are. Needs elastix (apt install elastix).
"""
import argparse
import sys

try:
    import paraview  # noqa: F401  (so that Debian's VTK is found, which comes with ParaView)
    from sonovdb import register_phases
    from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader  # noqa: F401
except ImportError as error:
    raise SystemExit(
        f"{error}: ParaView and SonoVDB are built for Debian's Python, and this is {sys.version.split()[0]} "
        f"({sys.executable}): start the example with pvpython or /usr/bin/python3, and with SonoVDB's lib/python3/dist-packages "
        "in PYTHONPATH.") from None


def label_ids(text):
    return {int(word) for word in text.split(",")}


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("files", nargs="+", help="label maps of one grid, one a phase, or one 4-D NIfTI file")
parser.add_argument("--out", required=True, help="folder to write to")
parser.add_argument("--reference", type=int, default=0, help="number of the phase that the others are displaced from")
parser.add_argument("--moving", type=label_ids, metavar="IDS",
                    help="ids of the labels that the speckle rides on, as 1,2,5; else those that change, but not blood")
args = parser.parse_args()

try:
    paths = register_phases(args.files, args.out, args.reference, args.moving)
except ValueError as error:
    raise SystemExit(f"{error}.") from None
print(f"Wrote {len(paths)} phases, {paths[0]} to {paths[-1]}")
