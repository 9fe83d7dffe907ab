"""Every page of the manual has the options that its program's --help has, and no others.

Usage: manual_test.py MANUAL BUILD, the folders of the pages and of the programs.
"""

import pathlib
import re
import subprocess
import sys
import unittest

MANUAL, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


def help_of(program, *command):
    done = subprocess.run(
        [BUILD / program, *command, "--help"], capture_output=True, text=True, check=True
    )
    return done.stdout


def options_of(program):
    """The options of a program and of its subcommands."""
    text = help_of(program)
    commands = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.MULTILINE)
    for command in re.findall(r"^  (\w+)", commands.group(1), re.MULTILINE) if commands else []:
        text += help_of(program, command)
    text = re.sub(r"\[KEY=VALUE\].*", "", text)  # any question's parameters, and an example
    text = re.sub(r"^size=small, --place kitchen.*", "", text, flags=re.MULTILINE)
    return set(OPTION.findall(text))


def page_options(page):
    """Those that begin an entry of a page."""
    entries = re.findall(r"^\.TP\n(.*)", page.read_text(), re.MULTILINE)
    return set(OPTION.findall("\n".join(entries).replace("\\-", "-")))


class Manual(unittest.TestCase):
    def test_every_option_is_in_its_page_and_no_other(self):
        pages = sorted(MANUAL.glob("*.[18]"))
        self.assertGreater(len(pages), 4)
        checked = 0
        for page in pages:
            if not (BUILD / page.stem).exists():
                self.assertIn(page.stem, ("anchor-detect", "anchor-verify"), "built without OpenCV")
                continue
            with self.subTest(page.name):
                self.assertEqual(page_options(page), options_of(page.stem))
                checked += 1
        self.assertGreaterEqual(checked, 5)

    def test_every_installed_program_has_a_page(self):
        root = MANUAL.parent.parent
        installed = set()
        for lists in [root / "daemon/CMakeLists.txt", *root.glob("tools/*/CMakeLists.txt")]:
            installed.update(re.findall(r"^install\(TARGETS ([\w-]+)", lists.read_text(), re.M))
        self.assertEqual(installed, {page.stem for page in MANUAL.glob("*.[18]")})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
