# SPDX-License-Identifier: Apache-2.0
"""What a user gets without asking, and whether a cheaper choice in the same place is also more accurate."""

# Default, the families that could stand in its place, and the colours it is meant for. A program that takes cubes takes
# nothing else, some of them no curve before it either, and a cube is meant for colours inside the gamut and within seven
# stops.
DEFAULTS = (
    ("map 0.09", ("homogeneous map",), "all"),
    ("exact engine 251", ("exact engine",), "all"),
    ("chain 65, {ocio}", ("matrix", "chain, {ocio}", "fitted cube, {ocio}", "sampled cube, {ocio}"), "all"),
    ("fitted 1-D shaper + cube 33, {ocio}", ("matrix", "fitted 1-D shaper + cube, {ocio}", "fitted cube, {ocio}", "sampled cube, {ocio}"),
     "inside"),
    ("fitted cube 33, {ocio}", ("matrix", "fitted cube, {ocio}", "sampled cube, {ocio}"), "inside"),
)


def _releases(rows):
    return dict.fromkeys(row["family"].split(", ")[1] for row in rows if row["family"].startswith("chain, "))


def _is_faster(row, than):
    """By more than what noise did to both."""
    return row["nanoseconds_per_pixel"] * (1 + row["noise"] + than["noise"]) < than["nanoseconds_per_pixel"]


def faster_and_more_accurate(rows):
    """[(pair, default, the other)] of the section `transforms`: rows."""
    found = []
    for pair in dict.fromkeys(row["pair"] for row in rows):
        ours = {row["label"]: row for row in rows if row["pair"] == pair}
        for label, families, colours in DEFAULTS:
            for ocio in _releases(rows) if "{ocio}" in label else [""]:
                default = ours[label.format(ocio=ocio)]
                stand_ins = {family.format(ocio=ocio) for family in families}
                found += [(pair, default, row) for row in ours.values()
                          if row["family"] in stand_ins and _is_faster(row, default)
                          and row["error"][colours]["p99"] < default["error"][colours]["p99"]]
    return found


def beaten(rows):
    """Where the other is no larger either: it costs less in every way and is more accurate."""
    return [(pair, default["label"], row["label"]) for pair, default, row in faster_and_more_accurate(rows)
            if row["bytes"] <= default["bytes"]]


def markdown(rows):
    found = beaten(rows)
    lines = ["Cheaper (faster beyond noise, and no larger) and more accurate (p99) than the default in the same place: " +
             ("; ".join(f"{name} than {default} ({pair})" for pair, default, name in found) or "none") +
             ". Defaults: map 0.09, 251 bands, a `.ctf` of 65 nodes, fitted cubes of 33, with and without a 1-D shaper."]
    larger = [(pair, default, row) for pair, default, row in faster_and_more_accurate(rows) if row["bytes"] > default["bytes"]]
    if larger:
        lines += ["", "Faster in this run and more accurate, but larger: " +
                  "; ".join(f"{row['label']} than {default['label']}, {row['bytes'] / default['bytes']:.1f} times its size ({pair})"
                            for pair, default, row in larger) +
                  ". A cube of 65 takes `--size 65`; many programs, monitors and cameras take no more than 33."]
    return lines
