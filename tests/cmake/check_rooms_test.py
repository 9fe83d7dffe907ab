"""cmake/check_rooms.py finds what it should, and only that."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cmake"))
import check_rooms  # noqa: E402


class CheckRooms(unittest.TestCase):
    def violations(self, path: str, text: str) -> list[str]:
        """What is found in a tree of which `path` with `text` is the only file."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, path)
            file.parent.mkdir(parents=True)
            file.write_text(text)
            return check_rooms.check(pathlib.Path(folder))

    def test_rooms_keep_to_their_table(self):
        for room, others in check_rooms.ROOMS.items():
            for other in check_rooms.ROOMS:
                found = self.violations(f"{room}/a.cc", f'\n#include "{other}/b.h"\n')
                if other == room or other in others:
                    self.assertEqual(found, [], (room, other))
                else:
                    self.assertEqual(len(found), 1, (room, other))
                    self.assertTrue(found[0].startswith(f"{room}/a.cc:2: "), found)

    def test_programs_and_tests_may_include_every_room(self):
        for free in check_rooms.FREE:
            self.assertEqual(self.violations(f"{free}/x/a.cc", '#include "mht/b.h"\n'), [])

    def test_no_room_includes_a_program(self):
        self.assertEqual(len(self.violations("api/a.cc", '#include "daemon/b.h"\n')), 1)

    def test_libraries_belong_to_their_rooms(self):
        for header, right, wrong in [
            ("sqlite3.h", "knowledge/frame_log.cc", "api/server.cc"),
            ("nlohmann/json.hpp", "knowledge/configuration.cc", "knowledge/frame_log.cc"),
            ("lcm/lcm-cpp.hpp", "lcmtypes/codec.cc", "daemon/main.cc"),
            ("anchord/frame_t.hpp", "api/lcm_front.cc", "anchoring/world.cc"),
            ("opencv2/core.hpp", "perception/blobs.h", "geometry/view.h"),
            ("thread", "daemon/main.cc", "mht/cluster.cc"),
            ("atomic", "api/snapshot.h", "core/metrics.h"),
        ]:
            text = f"# include <{header}>\n"
            self.assertEqual(self.violations(right, text), [], header)
            self.assertEqual(len(self.violations(wrong, text)), 1, header)
            self.assertEqual(self.violations("tests/api/a_test.cc", text), [], header)

    def test_a_room_outside_the_table_is_named(self):
        found = self.violations("attic/a.h", "#include <vector>\n")
        self.assertEqual(len(found), 1)
        self.assertIn("attic/", found[0])

    def test_project_headers_are_included_from_the_root(self):
        self.assertEqual(len(self.violations("core/a.cc", '#include "b.h"\n')), 1)
        self.assertEqual(self.violations("tools/x/a.cc", '#include "b.h"\n'), [])


if __name__ == "__main__":
    unittest.main()
