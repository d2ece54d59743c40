# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Lines of BulletFEM in pybullet's server, each behind or before an anchor, a line of Bullet's source."""
import dataclasses
import pathlib
import re

SERVER = "examples/SharedMemory/PhysicsServerCommandProcessor.cpp"


@dataclasses.dataclass(frozen=True)
class Insertion:
    name: str  # for messages
    anchor: str  # the line, without its indentation; it must occur once
    lines: str
    before: bool = False


INSERTIONS = (
    Insertion("header", '#include "../Extras/Serialize/BulletWorldImporter/btMultiBodyWorldImporter.h"', '#include "fem_world.h"'),
    Insertion("bytes of a saved state", "btSerializer* m_serializer;", "std::vector<unsigned char> m_femState;"),
    Insertion("solvers of createEmptyDynamicsWorld", "solver->setDeformableSolver(m_data->m_deformablebodySolver);",
              "m_data->m_solver = solver = fem_world::replaceSolvers(m_data->m_deformablebodySolver, solver);"),
    # The constraint solver ends before the body solver that it refers to; Bullet's line then deletes null.
    Insertion("order of deleteDynamicsWorld", "delete m_data->m_deformablebodySolver;",
              "delete m_data->m_solver;\nm_data->m_solver = 0;", before=True),
    Insertion("saveState", "sd.m_serializer = ser;",
              "if (!fem_world::save(*m_data->m_dynamicsWorld, m_data->m_deformablebodySolver, sd.m_femState))\n"
              "\tserverCmd.m_type = CMD_SAVE_STATE_FAILED;"),
    # A state that does not fit is refused before Bullet changes rigid bodies; behind Bullet's part ours is the last word.
    Insertion("check of restoreState", "ok = importer->convertAllObjects(bulletFile);",
              "if (fem_world::restore(*m_data->m_dynamicsWorld, m_data->m_deformablebodySolver,\n"
              "\tm_data->m_savedStates[clientCmd.m_loadStateArguments.m_stateId].m_femState))", before=True),
    Insertion("restoreState", "ok = importer->convertAllObjects(bulletFile);",
              "ok = ok && fem_world::restore(*m_data->m_dynamicsWorld, m_data->m_deformablebodySolver,\n"
              "\tm_data->m_savedStates[clientCmd.m_loadStateArguments.m_stateId].m_femState);"),
)


def version_of(bullet: pathlib.Path) -> str:
    """The version of a source tree of Bullet, as its file VERSION has it."""
    try:
        return (bullet / "VERSION").read_text().strip()
    except OSError:
        raise SystemExit(f"{bullet} is no source tree of Bullet: it has no file VERSION") from None


def insert(text: str, version: str) -> str:
    """The source of pybullet's server with all lines. Exits, naming the anchor, if one is not there exactly once."""
    for insertion in INSERTIONS:
        pattern = re.compile(r"^([ \t]*)" + re.escape(insertion.anchor) + r"[ \t]*\r?$", re.MULTILINE)
        found = list(pattern.finditer(text))
        if len(found) != 1:
            raise SystemExit(f"{SERVER} of Bullet {version} has {len(found)} lines `{insertion.anchor}`, the anchor of "
                             f"{insertion.name}: it must have one; mend tools/pybullet/insert.py")
        indent = found[0][1]
        lines = "".join(f"{indent}{line}\n" for line in insertion.lines.split("\n"))
        at = found[0].start() if insertion.before else found[0].end() + 1
        text = text[:at] + lines + text[at:]
    return text
