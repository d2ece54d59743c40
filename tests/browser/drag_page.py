#!/usr/bin/python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Plays the browser page in headless Chromium: takes hold of the elephant with the mouse, drags it, lets it go, and
waits until it rests; then lifts it, and moves a slider. Needs Debian's chromium and python3-websockets.

    tests/browser/drag_page.py <folder of the page> <folder for pictures>

Exit code 1 where a check fails, 77 where Chromium or websockets is missing. No check asks how long something took; each
wait ends after WAIT seconds, when the page has stopped.
"""
import argparse
import asyncio
import base64
import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

try:
    import websockets
except ImportError:
    websockets = None

WAIT = 300  # [s]
SIZE = 960, 640
BEND, LIFT = [150, 60], [40, -200]  # mouse displacements [pixels]
BROWSER = ["--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
           "--enable-unsafe-swiftshader", "--remote-debugging-port=0", "--no-first-run",
           "--disable-background-networking",
           "--disable-dev-shm-usage", "--hide-scrollbars", f"--window-size={SIZE[0]},{SIZE[1]}"]


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Page:
    """The page by Chrome's DevTools protocol."""

    def __init__(self, socket):
        self.socket = socket
        self.number = 0
        self.problems = []  # exceptions, error messages, and requests to other servers

    async def send(self, method, **parameters):
        self.number += 1
        await self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(await asyncio.wait_for(self.socket.recv(), WAIT))
            self.look(message)
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]

    def look(self, message):
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] == "error":
            self.problems.append(str([each.get("value") for each in parameters["args"]]))
        elif method == "Network.requestWillBeSent":
            address = parameters["request"]["url"]
            if not address.startswith(("http://127.0.0.1:", "data:")):
                self.problems.append(f"it asks for {address}")

    async def value(self, expression):
        result = await self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    async def state(self):
        return await self.value("bulletfem.state()")

    async def until(self, expression):
        for _ in range(WAIT * 5):
            if await self.value(expression):
                return True
            if self.problems:
                return False
            await asyncio.sleep(0.2)
        return False

    async def after(self, seconds):
        """Waits for so much time of the scene."""
        began = (await self.state())["time"]
        return await self.until(f"bulletfem.state().time > {began + seconds}")

    async def rests(self):
        """Waits until it sleeps; two steps before, what happened has woken it."""
        steps = (await self.state())["steps"]
        return await self.until(f"bulletfem.state().steps > {steps + 2} && bulletfem.state().asleep")

    async def mouse(self, kind, place):
        await self.send("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left",
                        buttons=0 if kind == "mouseReleased" else 1, clickCount=1)

    async def picture(self, path):
        result = await self.send("Page.captureScreenshot", format="png")
        with open(path, "wb") as file:
            file.write(base64.b64decode(result["data"]))


class Checks:
    def __init__(self):
        self.failed = False

    def __call__(self, what, value, low, high):
        holds = value is not None and low <= value <= high
        self.failed = self.failed or not holds
        print(f"  {what:<44} {value:10.4g}  in [{low:g}, {high:g}]{'' if holds else '  FAILED'}", flush=True)


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


async def drag(page, check, start, way, picture):
    """Takes hold at a pixel, drags by `way` [pixels] in 20 moves, waits until it has followed. Gives the state then."""
    await page.mouse("mousePressed", start)
    taken = await page.state()
    check("the mouse holds the body", int(taken["held"] is not None), 1, 1)
    if taken["held"] is None:
        return None
    for k in range(1, 21):
        await page.mouse("mouseMoved", [x + d * k / 20 for x, d in zip(start, way)])
        await page.value("new Promise(requestAnimationFrame)")
    await page.after(3)
    state = await page.state()
    await page.picture(picture)
    moved = distance(state["target"], taken["target"])
    check("way of the mouse [m]", moved, 0.15, 5)
    check("way of the held point, towards the mouse, / it",
          1 - distance(state["held"], state["target"]) / moved, 0.35, 1)
    check("what is drawn is finite", int(state["finite"]), 1, 1)
    return taken, state


async def let_go(page, check, place):
    await page.mouse("mouseReleased", place)
    check("it comes to rest", int(await page.rests()), 1, 1)
    state = await page.state()
    check("speed of its fastest node [m/s]", state["fastest"], 0, 0.04)
    check("what is drawn is finite", int(state["finite"]), 1, 1)
    return state


async def play(page, check, out):
    """The checks."""
    check("the page is ready", int(await page.until("Boolean(window.bulletfem)")), 1, 1)
    if check.failed:
        return
    check("it comes to rest", int(await page.rests()), 1, 1)
    rest = await page.state()
    await page.picture(os.path.join(out, "rest.png"))
    check("tetrahedra", rest["tets"], 1000, 5000)

    # With fixed feet the body bends, and swings back.
    top = await page.value(HIGHEST)
    start = await page.value(f"bulletfem.pixelOf({json.dumps(top)})")
    start[1] += 6  # into the trunk
    dragged = await drag(page, check, start, BEND, os.path.join(out, "bent.png"))
    if dragged is None:
        return
    check("way of the centre [m]", distance(dragged[1]["centre"], rest["centre"]), 0.02, 1)
    back = await let_go(page, check, [x + d for x, d in zip(start, BEND)])
    check("centre from where it stood before [m]", distance(back["centre"], rest["centre"]), 0, 0.02)

    # Free, the body is lifted, and falls.
    await page.value("document.getElementById('feet').click()")
    await page.after(1)
    centre = (await page.state())["centre"]
    start = await page.value(f"bulletfem.pixelOf({json.dumps(centre)})")
    lifted = await drag(page, check, start, LIFT, os.path.join(out, "lifted.png"))
    if lifted is None:
        return
    check("rise of the centre [m]", lifted[1]["centre"][1] - lifted[0]["centre"][1], 0.1, 2)
    fallen = await let_go(page, check, [x + d for x, d in zip(start, LIFT)])
    check("height of the centre [m]", fallen["centre"][1], 0.05, 0.5)
    await page.picture(os.path.join(out, "fallen.png"))

    # A slider: a softer body is flatter.
    await page.value("""{ const young = document.getElementById('young'); young.value = young.min;
                          young.dispatchEvent(new Event('input')); }""")
    check("it comes to rest", int(await page.rests()), 1, 1)
    await page.picture(os.path.join(out, "softer.png"))
    softer = await page.state()
    check("centre, softer / before", softer["centre"][1] / fallen["centre"][1], 0.3, 0.97)
    print("  " + await page.value(MEASURE))


HIGHEST = """(() => {
    const count = bulletfem.call.vertex_count(), v = bulletfem.numbers(bulletfem.call.vertices(), 6 * count);
    let top = 0;
    for (let k = 0; k < count; ++k) if (v[6 * k + 1] > v[6 * top + 1]) top = k;
    return Array.from(v.slice(6 * top, 6 * top + 3));
})()"""
# A ball falls on the body of a new scene with fixed feet, and the body vibrates.
MEASURE = """(() => {
    const young = document.getElementById('young'), feet = document.getElementById('feet');
    bulletfem.call.set(3e5, 0.01, 9.81, 1 / 60);
    if (!feet.checked) feet.click();
    bulletfem.open();
    const ms = [];
    for (let k = 0; k < 180; ++k) {
        const began = performance.now();
        bulletfem.call.step();
        ms.push(performance.now() - began);
    }
    return `a step in Chromium, median ${ms.sort((a, b) => a - b)[90].toFixed(2)} ms`;
})()"""


async def run(port, address, check, out):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list", timeout=WAIT) as answer:
        target = next(each for each in json.load(answer) if each["type"] == "page")["webSocketDebuggerUrl"]
    async with websockets.connect(target, max_size=None) as socket:
        page = Page(socket)
        for domain in ("Runtime", "Page", "Network"):
            await page.send(f"{domain}.enable")
        await page.send("Page.navigate", url=address)
        await play(page, check, out)
        for problem in page.problems:
            print(f"  {problem}")
        text = await page.value("document.getElementById('error').textContent")
        check("problems of the page", len(page.problems) + (1 if text else 0), 0, 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", help="folder with index.html, as tools/wasm.sh leaves it")
    parser.add_argument("out", help="folder for pictures")
    arguments = parser.parse_args()
    browser = shutil.which("chromium")
    if not browser or websockets is None:
        print("left out: install Debian's chromium and python3-websockets")
        return 77
    os.makedirs(arguments.out, exist_ok=True)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0),
                                             functools.partial(QuietHandler, directory=arguments.page))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    check = Checks()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        with open(os.path.join(arguments.out, "chromium.log"), "w", encoding="utf-8") as log:
            chromium = subprocess.Popen([browser, *BROWSER, f"--user-data-dir={profile}", "about:blank"],
                                        stdout=log, stderr=log)
        try:
            address = f"http://127.0.0.1:{server.server_port}/"
            asyncio.run(run(port_of(profile, chromium), address, check, arguments.out))
        finally:
            chromium.terminate()
            chromium.wait()
    return 1 if check.failed else 0


def port_of(profile, chromium):
    """The port that Chromium has chosen for its DevTools."""
    name = os.path.join(profile, "DevToolsActivePort")
    for _ in range(WAIT * 5):
        if chromium.poll() is not None:
            break
        if os.path.exists(name) and os.path.getsize(name):
            with open(name, encoding="utf-8") as file:
                return int(file.readline())
        time.sleep(0.2)
    raise RuntimeError("chromium does not start: see chromium.log among the pictures")


if __name__ == "__main__":
    sys.exit(main())
