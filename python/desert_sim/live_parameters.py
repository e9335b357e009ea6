"""Live parameters by the names of config/parameters.md, and as messages of dynamic_reconfigure."""
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter, StrParameter


def config_of(parameters):
    """{"saltation.lift": 0.3, "step_rate": 20} as a Config. The node takes a number of either kind for each parameter, and
    a list as text."""
    config = Config()
    for path, value in parameters.items():
        name = path.replace(".", "__")
        if isinstance(value, bool):
            config.bools.append(BoolParameter(name, value))
        elif isinstance(value, int):
            config.ints.append(IntParameter(name, value))
        elif isinstance(value, float):
            config.doubles.append(DoubleParameter(name, value))
        elif isinstance(value, str):
            config.strs.append(StrParameter(name, value))
        else:
            config.strs.append(StrParameter(name, "[%s]" % ", ".join(repr(float(number)) for number in value)))
    return config


def parameters_of(config):
    """A Config as {"saltation.lift": 0.3, ...}."""
    lists = (config.bools, config.ints, config.strs, config.doubles)
    return {entry.name.replace("__", "."): entry.value for entries in lists for entry in entries}
