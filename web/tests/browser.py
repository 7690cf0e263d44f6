#!/usr/bin/env python3
"""Opens the page in a real headless Chromium, and checks what a user would see.

    web/tests/browser.py [FOLDER]

Needs chromium, chromedriver, and the page built (`cargo run --release --manifest-path web/Cargo.toml -- build`). Screenshots
go to FOLDER, if it is given. Standard library only: chromedriver speaks HTTP and JSON.
"""

import base64
import functools
import http.server
import json
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

WEB = pathlib.Path(__file__).resolve().parent.parent
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
         "--disable-background-networking", "--disable-component-update"]


class Quiet(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".wasm": "application/wasm"}

    def log_message(self, *arguments):
        pass


class Browser:
    """A session of Chromium, driven by WebDriver."""

    def __init__(self, profile):
        self.driver = subprocess.Popen(["chromedriver", "--port=9517"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.base = "http://127.0.0.1:9517"
        options = {"args": [*FLAGS, f"--user-data-dir={profile}"]}
        capabilities = {"alwaysMatch": {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}
        for _ in range(100):
            try:
                answer = self.post("/session", {"capabilities": capabilities})
                break
            except OSError:
                time.sleep(0.1)
        self.base += f"/session/{answer['sessionId']}"

    def post(self, path, body):
        request = urllib.request.Request(self.base + path, json.dumps(body).encode(), {"Content-Type": "application/json"})
        return json.load(urllib.request.urlopen(request, timeout=120))["value"]

    def run(self, script):
        return self.post("/execute/sync", {"script": script, "args": []})

    def wait(self, script, seconds):
        end = time.time() + seconds
        while time.time() < end:
            if self.run(f"return !!({script})"):
                return
            time.sleep(0.1)
        raise AssertionError(f"not within {seconds} s: {script}; {self.run('return document.body.innerText')}")

    def open(self, url, width=1200, height=1000):
        self.post("/window/rect", {"width": width, "height": height})
        self.post("/url", {"url": "about:blank"})
        self.post("/url", {"url": url})
        self.wait("window.rolls && rolls.state()", 20)

    def errors(self):
        entries = self.post("/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]

    def picture(self, path):
        with urllib.request.urlopen(self.base + "/screenshot", timeout=60) as answer:
            path.write_bytes(base64.b64decode(json.load(answer)["value"]))

    def close(self):
        # Without its end, the session's Chromium would outlive the driver.
        urllib.request.urlopen(urllib.request.Request(self.base, method="DELETE"), timeout=30)
        self.driver.terminate()


def native(oscillations, friction, inelasticity, seed):
    """Returns hash and collisions of the same run without a browser."""
    command = ["cargo", "run", "--quiet", "--release", "--manifest-path", str(WEB / "Cargo.toml"), "--bin", "native", "--"]
    numbers = [oscillations, friction, inelasticity, seed]
    answer = subprocess.run([*command, *map(str, numbers)], check=True, capture_output=True, text=True)
    state, collisions = answer.stdout.split()
    return state, int(collisions)


def check(browser, page, shots):
    def shot(name):
        if shots:
            browser.picture(shots / f"{name}.png")

    # The state after 500 oscillations has the hash of the native run, however many frames it took.
    for friction, inelasticity, seed in [(0.03, 0, 1), (0.1, 0.05, 7)]:
        link = f"{page}#friction={friction}&inelasticity={inelasticity}&seed={seed}&until=500&speed=2000"
        browser.open(link)
        browser.wait("rolls.isPaused() && rolls.state().oscillation === 500", 60)
        seen = browser.run("return [rolls.state().hash, rolls.state().collisions]")
        assert seen == list(native(500, friction, inelasticity, seed)), (seen, native(500, friction, inelasticity, seed))
        print(f"κ = {friction}, q = {inelasticity}: hash {seen[0]} after {seen[1]} collisions, as natively")

    # Sixty frames a second at 300 oscillations a second is the aim.
    for speed in [300, 2000]:
        browser.open(f"{page}#speed={speed}")
        time.sleep(6)
        rates = browser.run("return [rolls.rates.frames, rolls.rates.oscillations, rolls.rates.collisions, rolls.rates.busyCollisions]")
        print("speed {}: {:.0f} frames, {:.0f} oscillations, {:.2e} collisions a second; {:.2e} while it computes".format(speed, *rates))
        assert min(rates) > 0

    # Sliders act: the grains fall more slowly, and the base changes.
    browser.open(f"{page}#speed=300")
    before = browser.run("return Array.from(rolls.state().disks.slice(0, 30))")
    browser.run("for (const [name, at] of [['friction', 0.8], ['gravity', 0.2], ['amplitude', 0.4], ['frequency', 0.6]]) {"
                "const slider = document.getElementById(name); slider.value = at; slider.dispatchEvent(new Event('input')); }")
    time.sleep(1)
    after = browser.run("return [rolls.settings, Array.from(rolls.state().disks.slice(0, 30)), rolls.state().waiting]")
    assert after[1] != before and after[0]["gravity"] < 0.01 and not after[2], after
    browser.wait("document.getElementById('message').textContent === ''", 30)

    # Slow motion marks single collisions; a step goes to the next one.
    browser.open(f"{page}#speed=0.5")
    browser.run("document.getElementById('pause').click()")
    time.sleep(0.5)
    first = browser.run("return rolls.state().collisions")
    browser.run("document.getElementById('step').click()")
    browser.wait(f"rolls.state().collisions !== {first} || rolls.state().oscillation > 0", 30)
    shot("slow")

    # One roll at small friction, two at larger.
    for friction, expected, oscillations in [(0.03, "one roll", 6000), (0.08, "two rolls", 6000)]:
        browser.open(f"{page}#friction={friction}&speed=2000&until={oscillations}")
        browser.wait("rolls.isPaused()", 150)
        verdict = browser.run("return rolls.verdict()")
        shot(f"friction-{friction}")
        assert verdict.startswith(expected), (friction, verdict)
        print(f"κ = {friction}: {verdict} after {oscillations} oscillations")

    # A telephone: nothing is wider than the screen.
    browser.open(f"{page}#friction=0.08&speed=2000", 500, 900)
    time.sleep(3)
    assert browser.run("return document.documentElement.scrollWidth <= window.innerWidth")
    shot("telephone")
    errors = browser.errors()
    assert not errors, errors


def main():
    shots = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else None
    if shots:
        shots.mkdir(parents=True, exist_ok=True)
    handler = functools.partial(Quiet, directory=str(WEB / "dist"))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        try:
            check(browser, f"http://127.0.0.1:{server.server_address[1]}/index.html", shots)
        finally:
            browser.close()
    print("the page does what it should")


main()
