"""Runs the recipes of docs/guide/recipes.md: blocks of Python here, and those of LAMMPS by its program."""

import os
import pathlib
import re
import subprocess
import sys
import traceback

page, folder, readers = pathlib.Path(sys.argv[1]).read_text(), sys.argv[2], sys.argv[3:]
modules = {"ovito": "ovito", "ase": "ase", "pandas": "pandas", "polars": "polars", "MDAnalysis": "MDAnalysis"}
modules |= {"freud": "freud-analysis", "gsd": "gsd"}
os.chdir(folder)
done = 0
for language, block in re.findall(r"^```(python|lammps)\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL):
    names = re.findall(r"^(?:from|import) (\w+)", block, flags=re.MULTILINE) if language == "python" else ["lammps"]
    missing = [name for name in names if modules.get(name, name) not in readers]
    if missing:
        print(f"SKIPPED, A RECIPE NEEDS {', '.join(missing)}", file=sys.stderr)
        continue
    if language == "python":
        try:
            exec(compile(block, f"recipe of {names[0]}", "exec"), {})
        except Exception:
            traceback.print_exc()
            sys.exit(f"error: the recipe of {names[0]} fails")
    else:
        pathlib.Path("in.recipe").write_text(block)
        binaries = pathlib.Path(sys.executable).parent
        environment = dict(os.environ, LD_LIBRARY_PATH=str(binaries.parent / "lib"))
        command = [str(binaries / "lmp"), "-in", "in.recipe", "-screen", "none", "-log", "recipe.log"]
        subprocess.run(command, env=environment, check=True, timeout=60)
    done += 1
print(f"{done} recipes run")
