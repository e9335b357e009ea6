"""How much memory a node takes."""
import resource

# For Node(environment=...): glibc keeps what was freed of large buffers in up to eight arenas per processor, for a long time
# at random. Then a node's memory tells nothing of leaks; with a fixed threshold it is returned at once.
RETURNS_LARGE_BUFFERS = {"MALLOC_MMAP_THRESHOLD_": str(1 << 20), "MALLOC_TRIM_THRESHOLD_": str(1 << 20)}


def memory_of(node):
    """Of a desert_sim.testing.Node, what is in memory now [bytes]."""
    with open("/proc/%d/statm" % node.process.pid) as file:
        return int(file.read().split()[1]) * resource.getpagesize()
