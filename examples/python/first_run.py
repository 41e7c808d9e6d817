"""
A first run
===========

Load a die compaction, change its material, run it, look at its curves and events, and keep it.
"""

import argparse

import monograin as mg

parser = argparse.ArgumentParser(description="A first run.")
parser.add_argument(
    "-o", "--output", default="runs/first", help="folder of the run [%(default)s]"
)
options = parser.parse_args()

# %%
# ``mg.scenario`` gives a ready scenario, ``mg.Scenario.load`` one of your own. ``replace`` changes keys of a copy. The
# die compaction gets a softer material:

scenario = mg.scenario("die")  # or mg.Scenario.load("my.toml")
softer = scenario.replace({"material.yield_stress": "30 MPa"})
run = softer.run()
print(run)

# %%
# Every column of the history is a numpy array, in SI units:

force, displacement = run["axial.force"], run["axial.displacement"]
print(f"largest force {force.max():.1f} {run.units['axial.force']}", end=" ")
print(f"at {1e3 * displacement[force.argmax()]:.2f} mm")

# %%
# Events are the instants at which a regime changes:

for event in run.events:
    print(f"{event['time']:.6f} s  {event['class']:<10} {event['event']}")

# %%
# ``compare`` measures the difference of two runs:

comparison = mg.compare(scenario.run(), run, x="axial.displacement", y="axial.force")
share = 100.0 * comparison.curves[0].linf
print(f"against 50 MPa the force differs by up to {share:.0f} % of the largest one")

# %%
# ``save`` writes the files that ``monograin run`` writes, ``plot`` draws the curves with matplotlib:

run.save(options.output)
figure = run.plot()
figure.savefig(f"{options.output}/curves.png")
print(f"-> {options.output}")
figure
