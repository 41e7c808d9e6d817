"""Contact laws in closed form.

Every function takes numbers or arrays, which broadcast as in numpy, and returns a float or an array. Outside the domain
of a law the result is nan, as it is for masked elements. Inadmissible parameters, such as a negative yield stress, and
arrays that do not broadcast raise ``ValueError``; what is no real number raises ``TypeError``. Other threads go on while
a long array is evaluated, and Ctrl-C ends it; a curve of :func:`mdr.peel_curve` is completed first.

As in numpy, ``out`` names an array that receives the result, so that a loop needs no new array for each call. It may be
one of the arguments.

- :mod:`monograin.laws.hertz`: an elastic sphere at a rigid wall
- :mod:`monograin.laws.curved_sphere`: an elastic sphere at a rigid wall, with the curvature of the sphere's profile
- :mod:`monograin.laws.line_contact`: an elastic cylinder between two walls
- :mod:`monograin.laws.mdr`: elastic, adhesive and fully plastic contacts of the method of dimensionality reduction
- :mod:`monograin.laws.cel`: one contact of an elastic-perfectly plastic sphere, with unloading
- :mod:`monograin.laws.similarity`: a rigid-plastic sphere that hardens by a power law, small contacts
- :mod:`monograin.laws.semimech`: an elastic-ideally plastic sphere between walls, up to a filled die
- :mod:`monograin.laws.hardening`: a rigid-plastic sphere that hardens by a power law, up to a filled die
- :mod:`monograin.laws.ludwik`: Ludwik's hardening, and the power law nearest to it
- :mod:`monograin.laws.compressible`: a compressible plastic particle
- :mod:`monograin.laws.packing`: a packing of soft discs
"""

from . import (
    cel,
    compressible,
    curved_sphere,
    hardening,
    hertz,
    line_contact,
    ludwik,
    mdr,
    packing,
    semimech,
    similarity,
)

__all__ = [
    "cel",
    "compressible",
    "curved_sphere",
    "hardening",
    "hertz",
    "line_contact",
    "ludwik",
    "mdr",
    "packing",
    "semimech",
    "similarity",
]
