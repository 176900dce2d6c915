"""granrad: radiation and conduction in granular flows.

Arrays are NumPy float64 in SI units. Errors of the library arrive as exceptions: InputError (a ValueError),
NumericalError (an ArithmeticError), IoError (an OSError), ThresholdMissed; all are GranradErrors.

    import granrad
    factors = granrad.trace(centres, radii, box=[[0, 0, 0], [0.01, 0.004, 0.05]])
    flow = granrad.Simulation("plug.toml"); rows = flow.run()
    case = granrad.Case("out/plug"); case.history()["h_wp_W_m2K"]
"""
from ._granrad import (Correlation, GranradError, InputError, IoError, NumericalError, ThresholdMissed, __version__,
                       data_folder, exact_two_sphere, git_sha)
from .cases import Case, read_study
from .exchange import ViewFactors, fit, read_view_factors, trace
from .simulations import Simulation, heats

__all__ = ["Case", "Correlation", "GranradError", "InputError", "IoError", "NumericalError", "Simulation",
           "ThresholdMissed", "ViewFactors", "data_folder", "exact_two_sphere", "fit", "git_sha", "heats",
           "read_study", "read_view_factors", "trace"]
