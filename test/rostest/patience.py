"""How much longer everything may take: with sanitizers, or on a machine that has much else to do."""
import os

PATIENCE = float(os.environ.get("DESERT_PATIENCE", 1))
