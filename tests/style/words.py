"""Words that the field does not use, and what it says for them. Each check takes the root of a source tree and returns
its findings, one line of text each."""

import re

import checks

TEXTS = checks.CPP | checks.SCRIPTS | {".md", ".toml", ".txt", ".cmake"}
# Words, as wholes or as parts of a name in snake_case or CamelCase, with the term to use.
WORDS = {
    "rub": "friction", "rubs": "friction", "rubbed": "frictional", "rubbing": "frictional",
    "leaver": "escaped particle", "leavers": "escaped particles",
    "kin": "matching contact", "kinship": "matching contact",
    "neck": "JKR contact", "necks": "JKR contacts",
    "grip": "derivative with the normal force", "leverage": "lever-arm ratio",
    "sharpness": "(omega h)^2", "stiffening": "stiffness ratio",
    "kelvin": "NormalLawParameters", "voigt": "NormalLawParameters",
    "booked": "accounted for", "brick": "cell block", "bricks": "cell blocks",
    "flying": "agitated", "remembers": "stores", "forgets": "resets",
}
PHRASES = {
    "gives way": "yields", "give way": "yield", "repeat each other": "are redundant", "past a sheet": "penetrated",
    "twin file": "double-buffered file", "halo lane": "halo stream", "device room": "arena",
    "frozen limit": "lagged friction limit", "standing contact": "cached contact",
}
# Names of datasets in checkpoints, which earlier versions wrote.
FILE_FORMAT = {"shapes/rubbing_losses"}
# Where such words are the subject: what users search for, what keys were called, and what changed.
ABOUT_WORDS = {"CHANGELOG.md", "src/deck/synonyms.hpp", "tests/style/words.py", "tests/style/test_words.py"}


def parts(name):
    """The words of a name, in lower case."""
    return [part.lower() for part in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)]


def private_words(root):
    findings = []
    for file in checks.files(root, TEXTS):
        if str(file) in ABOUT_WORDS:
            continue
        for number, line in enumerate((root / file).read_text(encoding="utf-8").splitlines(), 1):
            for name in FILE_FORMAT:
                line = line.replace(name, "")
            found = [word for name in re.findall(r"[A-Za-z_]\w*", line) for word in parts(name) if word in WORDS]
            said = " ".join(re.findall(r"[a-z]+", line.lower()))
            found += [phrase for phrase in PHRASES if phrase in said]
            findings += [f"{file}:{number}: \"{word}\"; the field says \"{WORDS.get(word) or PHRASES[word]}\""
                         for word in dict.fromkeys(found)]
    return findings
