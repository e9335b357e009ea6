"""The Python package desert_sim, for catkin_python_setup(): the messages are generated beside it."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["desert_sim", "desert_sim.testing"], package_dir={"": "python"}))
