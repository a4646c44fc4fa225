"""Files of meshes that are refused, each with its message, and those that are put right, each with its warning.
Usage: SCREE=path/to/scree python3 test_mesh_files.py"""

import json
import struct
import unittest

from test_cli import DONE, IO_FAILED
from test_meshes import CORNERS, FACES, TWO_RANKS, MeshTest, stl


def binary_stl(count, faces):
    data = b"\0" * 80 + struct.pack("<I", count)
    for face in faces:
        data += struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in CORNERS[c]), 0)
    return data


class BadFileTest(MeshTest):
    BAD = [
        ("a hole", stl(FACES[:3] + FACES[4:]), "3 edges have one triangle", "of triangle"),
        ("a fin", stl(FACES + [(0, 1, 7)]), "an edge has more than two triangles", "of triangles 0, 4 and 12",
         "sheet = true takes it"),
        ("one in another", stl(FACES) + stl(FACES, [tuple(0.05 + x / 2 for x in c) for c in CORNERS]),
         "a shell lies inside another", "that of triangle 12", "sheet = true takes it"),
        ("nothing but points", stl([(0, 0, 1)]), "no triangles"),
        ("not a number", stl(FACES).replace("vertex 0.2 0.0 0.0", "vertex nan 0.0 0.0", 1),
         "rock.stl:6: coordinate \"nan\"", "must be a finite number"),
        ("no triangles", stl([]), "triangle", "no"),
        ("2^31 faces", binary_stl(2**31, FACES), "2147483648", "triangles"),
        ("a cut file", binary_stl(12, FACES)[:-30], "12", "triangle"),
        ("a cut text", stl(FACES)[:400], "rock.stl:27: ends before a coordinate"),
    ]
    # What is put right, each with its warning (test_mesh_repair.py has more).
    REPAIRED = [
        ("a flipped face", stl(FACES[:5] + [FACES[5][::-1]] + FACES[6:]), "1 of its 12 triangles is turned",
         "triangle 5 ("),
        ("a duplicate", stl(FACES + FACES[:1]), "1 triangle with the corners of others is left out", "triangle 12 ("),
        ("inside out", stl([face[::-1] for face in FACES]), "all of its 12 triangles ran clockwise", "sheet = true"),
        ("a point for a triangle", stl(FACES + [(0, 0, 1)]), "1 triangle without area is left out", "triangle 12 ("),
    ]

    def test_what_is_put_right_is_warned_of_once_and_stands_in_the_run_record(self):
        for name, content, *words in self.REPAIRED:
            with self.subTest(name):
                self.write("rock.stl", content)
                result = self.expect(DONE, "check", self.deck)
                self.assertIn("closed; (0, 0, 0) to (0.2, 0.2, 0.2) m, area 0.24 m^2, volume 0.008 m^3", result.stdout)
                self.run_deck(DONE, "out")
                warnings = json.loads((self.folder / "out/run_record.json").read_text())["warnings"]
                for texts in (result.stderr.splitlines(), warnings):
                    texts = [text for text in texts if 'mesh "rock" (rock.stl): ' in text]
                    self.assertEqual(len(texts), 1, texts)
                    for word in words:
                        self.assertIn(word, texts[0])

    def test_every_bad_file_is_refused_with_its_place(self):
        for name, content, *words in self.BAD:
            with self.subTest(name):
                message = self.of_file(content)
                for word in words:
                    self.assertIn(word, message)

    def test_on_two_ranks_the_message_is_one(self):
        for name, content, *words in self.BAD[:1] + self.BAD[6:7]:
            with self.subTest(name):
                self.assertIn(words[0], self.of_file(content, launcher=TWO_RANKS))

    def test_a_file_that_is_not_there(self):
        self.assertIn("rock.stl cannot be read: No such file or directory", self.refusal())

    def test_a_pointer_that_git_lfs_has_left_is_named_as_one(self):
        pointer = f"version https://git-lfs.github.com/spec/v1\noid sha256:{'4d' * 32}\nsize 51284\n"
        for launcher in ((), TWO_RANKS):
            self.assertIn('rock.stl is a Git LFS pointer in place of the file; "git lfs pull" fetches the file',
                          self.of_file(pointer, launcher=launcher))
        self.write("rock.stl", stl(FACES))
        self.write("grains.h5", pointer)
        settings = "particles=[{kind=\"file\",file=\"grains.h5\",radius=0.05,mass=1.0}]"
        self.assertIn("grains.h5 is a Git LFS pointer", self.refusal("--set", settings))
        result = self.expect(IO_FAILED, "run", self.deck, "--restart", "grains.h5", "--output", "out")
        self.assertIn("grains.h5: is a Git LFS pointer", result.stderr)
        result = self.expect(IO_FAILED, "check", self.write("pointer.toml", pointer))
        self.assertIn("pointer.toml: is a Git LFS pointer", result.stderr)


if __name__ == "__main__":
    unittest.main()
