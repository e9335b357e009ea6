#!/usr/bin/env python3
"""A build with DESERT_PARTS=client: its libraries and its Python module need none of the simulation's libraries.

    client_part.py BUILD
"""
import glob
import os
import re
import subprocess
import sys
import unittest

NOT_NEEDED = "gdal|opencv|ompl|nlopt|netcdf|fftw|cuda|cufft|Ogre|rviz|Qt|desert_(core|physics|io|ros|rover|planner|render)"
BUILD = sys.argv.pop(1)


class ClientPart(unittest.TestCase):
    def test_libraries_need_none_of_the_simulations(self):
        libraries = glob.glob(os.path.join(BUILD, "devel", "lib", "*.so"))
        names = {os.path.basename(path) for path in libraries}
        self.assertEqual(names, {"libdesert_base.so", "libdesert_client.so", "libdesert_testing.so"})
        for path in libraries:
            needed = subprocess.run(["readelf", "-d", path], check=True, stdout=subprocess.PIPE, universal_newlines=True)
            found = re.findall(r"NEEDED.*\[(.*)\]", needed.stdout)
            self.assertTrue(found, path)
            self.assertEqual([name for name in found if re.search(NOT_NEEDED, name)], [], path)

    def test_python_module_does_without_opencv(self):
        code = ("import sys; sys.modules['cv2'] = None\n"  # what imports it gets an ImportError
                "import desert_sim.testing, desert_sim.msg, desert_sim.srv\n"
                "from desert_sim import LayerMap, Rover, Simulation, TerrainClient\n"
                "print(desert_sim.__file__, desert_sim.testing.desert.NO_PICTURE)")
        command = ". %s/devel/setup.sh && exec \"$0\" -c \"$1\"" % BUILD
        run = subprocess.run(["sh", "-c", command, sys.executable, code], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             universal_newlines=True)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn(os.path.join(BUILD, "devel"), run.stdout)
        self.assertIn("python3-opencv", run.stdout)


if __name__ == "__main__":
    unittest.main()
