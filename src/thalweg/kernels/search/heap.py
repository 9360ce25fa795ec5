"""An indexed heap with four children per slot: each node is in it once, its key can fall."""

from thalweg.kernels.compilation.decorators import inlined


@inlined
def _move_up(nodes, keys, place, slot, node, key):
    while slot > 0:
        parent = (slot - 1) >> 2
        if keys[parent] <= key:
            break
        nodes[slot] = nodes[parent]
        keys[slot] = keys[parent]
        place[nodes[slot]] = slot
        slot = parent
    nodes[slot] = node
    keys[slot] = key
    place[node] = slot


@inlined
def push_or_lower(nodes, keys, place, size, node, key):
    """Insert a node, or lower its key; return the new size.

    Parameters
    ----------
    nodes : int32[N], keys : float64[N]
        The heap: node and key by slot.
    place : int32[N]
        Slot of each node, -1 when it is not in the heap.
    size : int
        Number of nodes in the heap.
    node, key : int, float
        ``key`` must not be above the key the node has.
    """
    slot = place[node]
    if slot < 0:
        slot = size
        size += 1
    _move_up(nodes, keys, place, slot, node, key)
    return size


@inlined
def pop_least(nodes, keys, place, size):
    """Remove the node of least key; return (node, key, new size). The heap must not be empty."""
    top, top_key = nodes[0], keys[0]
    place[top] = -1
    size -= 1
    if size == 0:
        return top, top_key, size
    node, key = nodes[size], keys[size]
    slot = 0
    while True:
        first = 4 * slot + 1
        if first >= size:
            break
        best, best_key = first, keys[first]
        for child in range(first + 1, min(first + 4, size)):
            if keys[child] < best_key:
                best, best_key = child, keys[child]
        if best_key >= key:
            break
        nodes[slot] = nodes[best]
        keys[slot] = best_key
        place[nodes[slot]] = slot
        slot = best
    nodes[slot] = node
    keys[slot] = key
    place[node] = slot
    return top, top_key, size
