"""Makes the committed results again: every table and figure under results, and the tables of the pages.

  scripts/results --list               what there is, what it costs, which commit made the committed one
  scripts/results                      everything but what takes long; with --long everything
  scripts/results failure_vs_parallax  one result; a folder's name stands for all its results (scripts/results atlas)
  scripts/results --check tuning       makes it in build/results and compares with what is committed; changes nothing
  scripts/results --check --at-most 0.1  the same for what took at most so many CPU minutes
  scripts/results --blocks             only the tables of the pages, from the committed tables
  scripts/results --digests            stores the hashes of a few trials of each result, for the test results.digests

A result is an entry of results/results.toml: commands, files, cost. Its numbers stand in the pages between
"begin generated" and "end generated", and README.md.in beside a page says what they are made of. Nothing there is typed
by hand. Results do not depend on the number of threads or on the machine. What holds times (the benchmarks, the audit's
figure of complexity) is made again, but not compared. Figures are compared byte by byte: another version of matplotlib
draws other bytes. Some results need data that the repository does not hold; RCME_PAIRS and its like say where they are
([data] of results.toml).
"""

import argparse
import sys
import time
from pathlib import Path

import blocks
import digests
from recipes import ROOT, ResultError, chosen, default_programs, differing, fresh, keep, make, read_recipes
from special_blocks import made_by, version_words

START = time.monotonic()


def say(words):
    """Progress, with the time since the start."""
    seconds = int(time.monotonic() - START)
    print(f"[{seconds // 60:3d}:{seconds % 60:02d}] {words}", file=sys.stderr, flush=True)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="scripts/results", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="results or folders; default: all that are not long")
    parser.add_argument("--list", action="store_true", help="list the results and stop")
    parser.add_argument("--long", action="store_true", help="without names: also the long ones")
    parser.add_argument("--at-most", type=float, metavar="MINUTES",
                        help="of these only what took at most so many CPU minutes, as --list says; what needs something that "
                             "is not there is left out")
    parser.add_argument("--check", action="store_true",
                        help="compare with what is committed instead of replacing it (exit code 1: something differs); "
                             "with --blocks or --digests: only compare these")
    parser.add_argument("--blocks", action="store_true", help="only the generated blocks of the pages")
    parser.add_argument("--digests", action="store_true", help="only the stored hashes")
    parser.add_argument("--resume", action="store_true", help="go on with runs that were cut off")
    parser.add_argument("--scratch", type=Path, default=ROOT / "build" / "results", metavar="FOLDER",
                        help="where results are made before they are kept or compared (default: build/results)")
    parser.add_argument("--programs", type=Path, default=default_programs(), metavar="FOLDER",
                        help="where the programs are (default: build/release/bin)")
    return parser.parse_args(arguments)


def minutes_of(recipe, entries):
    """What it took when it was made last, else what its entry says."""
    return entries.get(recipe.name, {}).get("cpu_minutes", recipe.cpu_minutes)


def show_list(recipes):
    entries = made_by()
    for recipe in recipes.values():
        cost = f"{minutes_of(recipe, entries):g} CPU min" + (", long" if recipe.is_long() else "")
        print(f"{recipe.name:36}{recipe.folder:14}{cost:20}{version_words(entries.get(recipe.name))}")


def do_blocks(is_check):
    """The pages' blocks, written or compared."""
    if not is_check:
        for page in blocks.write_blocks():
            print(f"written: {page.relative_to(ROOT)}")
        return 0
    stale = blocks.stale_pages()
    for page in stale:
        print(f"{page.relative_to(ROOT)}: its generated blocks are not what the committed tables give; run "
              f"scripts/results --blocks")
    unknown, absent = blocks.unaccounted(read_recipes())
    for path in unknown:
        print(f"{path.relative_to(ROOT)}: no result of results/results.toml makes this file")
    for path in absent:
        print(f"{path.relative_to(ROOT)}: is missing, though results/results.toml names it")
    counts = [len(blocks.block_names(page)) for page in blocks.pages()]
    differs = bool(stale or unknown or absent)
    print(f"{sum(counts)} blocks of {sum(map(bool, counts))} pages; {'differences' if differs else 'all equal'}")
    return 1 if differs else 0


def do_digests(recipes, options):
    """The hashes of a few trials of each result, stored or compared."""
    differs, count, old, known = False, 0, digests.stored(), {}
    for recipe in recipes:
        missing = recipe.missing(options.programs)
        if not recipe.digest:
            continue
        if missing:
            print(f"{recipe.name}: not replayed: there is no {', '.join(missing)}")
            continue
        try:
            new = digests.digests_of(recipe, options.scratch / "digests", options.programs, known)
        except ResultError as error:
            print(f"{recipe.name}: not given any more: {error}")
            differs = True
            continue
        count += len(new)
        if not options.check:
            digests.store({recipe.name: new})
            continue
        words = digests.difference(recipe.name, old.get(recipe.name, {}), new)
        if words:
            print(words)
            differs = True
    print(f"{count} hashes of {len(recipes)} results: " + ("differences or errors" if differs else
                                                          "all as stored" if options.check else "stored"))
    return 1 if differs else 0


def do_results(recipes, options):
    """The results themselves, made and kept, or made and compared."""
    status = 0
    for recipe in recipes:
        missing = recipe.missing(options.programs)
        if missing:
            say(f"{recipe.name}: skipped: there is no {', '.join(missing)}")
            status = status if options.at_most else 2
            continue
        out = options.scratch / recipe.name
        if not options.resume:
            fresh(out)
        cpu_seconds = make(recipe, out, options.programs, say)
        if options.check:
            different = differing(recipe, out)
            status = max(status, 1 if different else 0)
            say(f"{recipe.name}: {cpu_seconds:.0f} s of CPU time; " +
                ("DIFFERS: " + ", ".join(different) if different else "the same as committed"))
        else:
            keep(recipe, out, None if options.resume else cpu_seconds)
            say(f"{recipe.name}: {cpu_seconds:.0f} s of CPU time; kept in results/{recipe.folder}")
    if not options.check:
        do_blocks(False)
    return status


def main(arguments):
    options = parse(arguments)
    options.programs, options.scratch = options.programs.resolve(), options.scratch.resolve()
    recipes = read_recipes()
    if options.list:
        show_list(recipes)
        return 0
    if options.blocks:
        return do_blocks(options.check)
    picked = chosen(recipes, options.names, options.long or options.digests)
    if options.at_most:
        entries = made_by()
        picked = [recipe for recipe in picked if minutes_of(recipe, entries) <= options.at_most]
    return do_digests(picked, options) if options.digests else do_results(picked, options)


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except ResultError as error:
        print(f"scripts/results: {error}", file=sys.stderr)
        sys.exit(2)
