"""A section of a Markdown file, written anew by one command: how tests/lab/RESULTS.md is kept."""
import re


def section(name, command, tables, claims):
    parts = [f"## {name}\n\n`{command}`\n"]
    for table in tables:
        parts.append(f"### {table.title}\n\n{table.as_markdown()}\n{table.note}\n")
    if claims:
        lines = [f"- **{claim.verdict}**: {claim.text}. {claim.figures}." for claim in claims]
        parts.append("### The paper's claims\n\n" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def replaced(document, name, text):
    """The document with its section of that name replaced by the text, or with the section added at its end."""
    begin, end = f"<!-- tests/lab/run: {name} -->", f"<!-- end of {name} -->"
    whole = f"{begin}\n{text}{end}\n"
    old = re.compile(re.escape(begin) + r".*?" + re.escape(end) + r"\n", re.DOTALL)
    if old.search(document):
        return old.sub(lambda _: whole, document, count=1)
    return (document.rstrip("\n") + "\n\n" if document.strip() else "") + whole
