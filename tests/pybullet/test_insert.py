# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Lines in pybullet's server, and messages where an anchor is missing."""
import insert
import pytest

ANCHORS = list(dict.fromkeys(each.anchor for each in insert.INSERTIONS))
SERVER = "".join(f"\t\t{anchor}\nother;\n" for anchor in ANCHORS)


def test_lines_stand_at_their_anchors():
    lines = insert.insert(SERVER, "3.25").split("\n")
    for each in insert.INSERTIONS:
        at = lines.index(f"\t\t{each.anchor}")
        inserted = [f"\t\t{line}" for line in each.lines.split("\n")]
        assert lines[at - len(inserted):at] == inserted if each.before else lines[at + 1:at + 1 + len(inserted)] == inserted
    assert [line for line in lines if line == "other;"] == ["other;"] * len(ANCHORS)


@pytest.mark.parametrize("each", insert.INSERTIONS, ids=lambda each: each.name)
def test_a_missing_or_second_anchor_is_named_with_file_and_version(each):
    for text in (SERVER.replace(each.anchor, ""), SERVER + each.anchor + "\n"):
        with pytest.raises(SystemExit) as refusal:
            insert.insert(text, "9.99")
        for part in (insert.SERVER, "Bullet 9.99", each.anchor, "insert.py"):
            assert part in str(refusal.value)


def test_folders_without_bullet_are_named(tmp_path):
    with pytest.raises(SystemExit, match="no source tree of Bullet"):
        insert.version_of(tmp_path)
