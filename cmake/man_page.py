#!/usr/bin/env python3
"""Writes the manual page of a program from what it says with --help: man_page.py PROGRAM VERSION OUT.gz

Help texts are taken as they are, those of a program's commands as sections of its page. The page does not tell
how many processors this machine has.
"""
import gzip
import pathlib
import re
import subprocess
import sys


def help_of(program, *command):
    text = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True).stdout
    return re.sub(r"(--(?:threads|jobs) N\s[^()]*\([^()]*default)\s+\d+\)", r"\1 one a core)", text)


def commands_in(help_text, name):
    """The commands that a help text lists, as 'Commands:' or as 'NAME COMMAND   what it does'."""
    listed = re.search(r"^Commands:\n((?:  .*\n)+)", help_text, re.MULTILINE)
    found = re.findall(r"^  ([a-z]\S*)  ", listed[1], re.MULTILINE) if listed else []
    return found + re.findall(rf"^  {name} ([a-z]+)  ", help_text, re.MULTILINE)


def summary_of(help_text):
    """Its first sentence, or the part before a colon, in one line and without a capital."""
    sentence = re.match(r"(.*?)[.:](?:\s|$)", help_text, re.DOTALL)[1]
    return sentence[0].lower() + " ".join(sentence[1:].split())


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.MULTILINE)


def section(title, text):
    return f".SH {title}\n.nf\n{escaped(text.strip())}\n.fi\n"


def page_of(program, version):
    name = pathlib.Path(program).name
    text = help_of(program)
    usage = re.search(r"^Usage: (.*)$", text, re.MULTILINE)[1]
    return "".join([
        f'.TH {name.upper()} 1 "" "milepost {version}" "milepost"\n',
        f".SH NAME\n{name} \\- {escaped(summary_of(text))}\n",
        section("SYNOPSIS", usage),
        section("DESCRIPTION", text),
        *(section(f"{name} {command}".upper(), help_of(program, command)) for command in commands_in(text, name))])


def main():
    if len(sys.argv) != 4:
        print("man_page.py: takes PROGRAM VERSION OUT.gz", file=sys.stderr)
        return 2
    program, version, out = sys.argv[1:]
    with open(out, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as page:
        page.write(page_of(program, version).encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
