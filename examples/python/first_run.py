"""A first run: load a scenario, change it, run it, look at its curves and events, keep it.

    python3 first_run.py [-o FOLDER]
"""

import argparse

import monograin as mg


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", default="runs/first", help="folder of the run [%(default)s]")
    folder = parser.parse_args().output

    scenario = mg.scenario("die")  # or mg.Scenario.load("my.toml")
    softer = scenario.replace({"material.yield_stress": "30 MPa"})
    run = softer.run()
    print(run)

    force, displacement = run["axial.force"], run["axial.displacement"]
    print(f"largest force {force.max():.1f} {run.units['axial.force']} at {1e3 * displacement[force.argmax()]:.2f} mm")
    for event in run.events:
        print(f"{event['time']:.6f} s  {event['class']:<10} {event['event']}")

    difference = mg.compare(scenario.run(), run, x="axial.displacement", y="axial.force").curves[0]
    print(f"against 50 MPa the force differs by up to {100.0 * difference.linf:.0f} % of the largest one")

    run.save(folder)
    try:
        run.plot().savefig(f"{folder}/curves.png")
    except ImportError:
        print("no figure: matplotlib is missing (Debian package python3-matplotlib)")
    print(f"-> {folder}")


if __name__ == "__main__":
    main()
