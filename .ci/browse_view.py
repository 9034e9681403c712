"""Turns a model in a real browser: `hiddenline view` in headless Chromium, driven by Selenium.

Usage: browse_view.py HIDDENLINE [FOLDER]

With FOLDER, pictures of the page are left there. Exits with 77 where the browser does not start.
"""

import base64
import contextlib
import http.server
import io
import pathlib
import shlex
import subprocess
import sys
import tempfile
import threading
import time

from PIL import Image, ImageChops, ImageFilter, ImageStat
from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--force-device-scale-factor=1",
]


@contextlib.contextmanager
def viewer(program, folder, *arguments):
    """Runs the viewer and gives its address."""
    command = [program, "view", "--no-open", *map(str, arguments)]
    process = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    try:
        for line in process.stderr:
            if line.startswith("http://127.0.0.1:"):
                break
        else:
            raise AssertionError("no address is printed")
        threading.Thread(target=process.stderr.read, daemon=True).start()
        yield line.strip(), process
    finally:
        process.terminate()
        assert process.wait(20) == 0, "ended with an error"


def browser(folder, size=(1280, 860)):
    options = webdriver.ChromeOptions()
    for flag in FLAGS:
        options.add_argument(flag)
    options.add_argument(f"--window-size={size[0]},{size[1]}")
    options.add_argument(f"--user-data-dir={tempfile.mkdtemp()}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    options.add_experimental_option("prefs", {"download.default_directory": str(folder)})
    service = webdriver.ChromeService("/usr/bin/chromedriver")
    options.binary_location = "/usr/bin/chromium"
    return webdriver.Chrome(options=options, service=service)


class Page:
    def __init__(self, driver, address):
        self.driver = driver
        driver.get("about:blank")
        driver.get(address)
        self.rest()

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def by(self, name):
        return self.driver.find_element(By.ID, name)

    def rest(self, seconds=40):
        """Waits for the exact drawing of what is set."""
        WebDriverWait(self.driver, seconds, 0.05).until(
            lambda _: self.js("return !!app.about && app.exactOf === app.version && !app.isTurning && !app.isAsking"))

    def drag(self, dx, dy, keys=()):
        canvas = self.by("paper")
        actions = ActionChains(self.driver, duration=50)
        for key in keys:
            actions.key_down(key)
        actions.move_to_element(canvas).click_and_hold().move_by_offset(dx // 2, dy // 2)
        actions.move_by_offset(dx - dx // 2, dy - dy // 2).release()
        for key in keys:
            actions.key_up(key)
        actions.perform()

    def camera(self):
        return self.js("return {azimuth: app.camera.azimuth, elevation: app.camera.elevation, height: app.camera.height}")

    def errors(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def downloaded(folder, name):
    path = pathlib.Path(folder, name)
    for _ in range(200):
        if path.exists() and not list(pathlib.Path(folder).glob("*.crdownload")):
            return path.read_bytes()
        time.sleep(0.05)
    raise AssertionError(f"{name} was not saved")


def written(program, folder, command):
    words = shlex.split(command)
    assert words[0] == "hiddenline", command
    with tempfile.TemporaryDirectory() as apart:
        output = pathlib.Path(apart, words[-1])
        subprocess.run([program, *words[1:-1], str(output), "-q"], cwd=folder, check=True)
        return output.read_bytes()


def check_turning(page):
    height = page.js("return document.getElementById('paper').clientHeight")
    before = page.camera()
    page.drag(-140, 60)
    after = page.camera()
    turned = (after["azimuth"] - before["azimuth"]) % 360
    assert abs(turned - 140 * 180 / height) < 0.11, (before, after, height)
    assert abs(after["elevation"] - before["elevation"] - 60 * 180 / height) < 0.11, (before, after)
    page.rest()
    assert page.by("badge").text == "exact"
    page.drag(0, 300)
    page.drag(0, 300)
    assert page.camera()["elevation"] == 90, "no further than from above"
    page.rest()


def check_keys(page):
    """From load to save by keys alone."""
    page.by("paper").send_keys("r")
    page.rest()
    page.by("paper").send_keys(Keys.ARROW_LEFT, Keys.ARROW_UP)
    camera = page.camera()
    assert (camera["azimuth"], camera["elevation"]) == (35, 20), camera
    with_shift = ActionChains(page.driver).key_down(Keys.SHIFT).send_keys(Keys.ARROW_RIGHT).key_up(Keys.SHIFT)
    with_shift.perform()
    assert page.camera()["azimuth"] == 34
    for key, view in [("1", "front"), ("3", "right"), ("7", "top"), ("0", "isometric")]:
        page.by("paper").send_keys(key)
        assert page.js("return app.camera.view") == view
    page.rest()
    assert "--view=isometric" in page.by("command").text
    page.by("paper").send_keys("5")
    page.rest()
    assert "--projection=perspective" in page.by("command").text
    page.by("paper").send_keys("+", "+", "-")
    assert page.camera()["height"], "zoomed"
    page.rest()
    page.by("paper").send_keys("f")
    page.rest()
    assert page.camera()["height"] is None


def check_saving(page, program, models, downloads):
    """What is saved has the bytes of the command that is shown; the button is reached by the tabulator."""
    page.js("document.getElementById('paper').focus()")
    for _ in range(40):
        page.driver.switch_to.active_element.send_keys(Keys.TAB)
        if page.driver.switch_to.active_element.get_attribute("id") == "save":
            break
    else:
        raise AssertionError("Save is not reached by the tabulator")
    page.driver.switch_to.active_element.send_keys(Keys.ENTER)
    command = page.by("command").text
    name = shlex.split(command)[-1]
    assert downloaded(downloads, name) == written(program, models, command), command
    for kind in ("pdf", "hpgl", "gcode", "dxf", "png"):
        Select(page.by("format")).select_by_value(kind)
        page.by("save").click()
        WebDriverWait(page.driver, 30).until(lambda _: page.by("saved").text.startswith("Saved"))
        WebDriverWait(page.driver, 30).until(lambda _: not page.by("save").get_property("disabled"))
        name = page.by("saved").text.removeprefix("Saved ")
        shown = page.by("command").text
        assert shlex.split(shown)[-1] == name, shown
        assert downloaded(downloads, name) == written(program, models, shown), shown
    Select(page.by("format")).select_by_value("svg")


def check_zooming(page, program, models):
    """A zoomed and panned view is what its command draws, and the place under the pointer stays."""
    page.by("paper").send_keys("r")
    page.rest()
    at = page.js("""
        const canvas = document.getElementById('paper');
        const [x, y] = [canvas.clientWidth * 0.6, canvas.clientHeight * 0.4];
        const event = new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true,
          clientX: canvas.getBoundingClientRect().x + x, clientY: canvas.getBoundingClientRect().y + y});
        canvas.dispatchEvent(event);
        return app.paper.millimeters(x, y);
    """)
    assert at
    page.rest()
    before = page.js("return app.camera.target")
    page.drag(40, 30, keys=[Keys.SHIFT])
    page.rest()
    assert page.js("return app.camera.target") != before
    assert b"<path" in written(program, models, page.by("command").text)
    page.js("""
        const canvas = document.getElementById('paper');
        const box = canvas.getBoundingClientRect();
        canvas.dispatchEvent(new MouseEvent('dblclick', {clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
    """)
    time.sleep(0.5)
    page.rest()
    page.by("paper").send_keys("r")
    page.rest()


def check_picture(page, program, models):
    """The paper on the canvas is the PNG of the command line, but for 2 %."""
    page.rest()
    octets = base64.b64decode(page.js("return app.paper.canvas.toDataURL('image/png').split(',')[1]"))
    left, top, scale, width, height = page.js(
        "const p = app.paper; return [p.left, p.top, p.scale, p.page.width, p.page.height]")
    canvas = Image.open(io.BytesIO(octets)).convert("RGBA")
    white = Image.new("RGBA", canvas.size, "white")
    canvas = Image.alpha_composite(white, canvas).convert("L")
    canvas = canvas.crop((round(left), round(top), round(left + scale * width), round(top + scale * height)))
    Select(page.by("format")).select_by_value("png")
    command = page.by("command").text
    Select(page.by("format")).select_by_value("svg")
    drawn = Image.open(io.BytesIO(written(program, models, command))).convert("L").resize(canvas.size, Image.LANCZOS)
    soft = [image.filter(ImageFilter.GaussianBlur(2)) for image in (canvas, drawn)]
    difference = ImageStat.Stat(ImageChops.difference(*soft)).mean[0] / 255
    assert difference < 0.02, difference
    blank = ImageStat.Stat(ImageChops.invert(canvas)).mean[0] / 255
    assert blank > 0.005, "nothing is on the canvas"


def check_options(page):
    box = page.by("option-crease")
    box.clear()
    box.send_keys("abc", Keys.TAB)
    WebDriverWait(page.driver, 20).until(lambda _: page.by("option-crease-error").is_displayed())
    assert "not a number" in page.by("option-crease-error").text
    box.clear()
    box.send_keys("60", Keys.TAB)
    WebDriverWait(page.driver, 20).until(lambda _: not page.by("option-crease-error").is_displayed())
    page.rest()
    assert "--crease=60" in page.by("command").text
    Select(page.by("option-hidden")).select_by_value("dashed")
    WebDriverWait(page.driver, 20).until(lambda _: "--hidden=dashed" in page.by("command").text)
    page.rest()
    page.js("document.getElementById('order').value = 0.5; document.getElementById('order').dispatchEvent(new Event('input'))")
    assert page.js("return app.paper.drawnMm < app.paper.totalMm")


def check_surface(page):
    field = page.by("formula-0")
    field.clear()
    field.send_keys("sin(x) +")
    error = WebDriverWait(page.driver, 20).until(lambda _: page.by("formula-0-error").is_displayed() and page.by("formula-0-error"))
    assert error.get_property("textContent").index("▲") == 8, error.text
    field.send_keys(" a*cos(y)")
    WebDriverWait(page.driver, 20).until(lambda _: page.driver.find_elements(By.ID, "parameter-a"))
    WebDriverWait(page.driver, 20).until(lambda _: not page.by("formula-0-error").is_displayed())
    page.rest()
    assert "--set=a=1" in page.by("command").text, page.by("command").text
    page.js("const s = document.getElementById('parameter-a'); s.value = -0.5; s.dispatchEvent(new Event('input'))")
    WebDriverWait(page.driver, 20).until(lambda _: "--set=a=-0.5" in page.by("command").text)


def check_foreign_page(page, address):
    """A page of another origin gets nothing, even with the token."""
    class Empty(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Empty)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    base, token = address.split("/#")
    page.driver.get(f"http://127.0.0.1:{server.server_port}/")
    outcome = page.driver.execute_async_script("""
        const [address, token, done] = arguments;
        const headers = {"X-Hiddenline-Token": token};
        fetch(address + "/api/draw", {method: "POST", headers, body: "{}"})
            .then((answer) => done("answered " + answer.status), () => done("refused"));
    """, base, token)
    server.shutdown()
    assert outcome == "refused", outcome
    page.driver.get_log("browser")  # The refusal is there.


def check_sizes(driver, address, pictures):
    """Nothing is wider than the window, on a telephone and at twice the size."""
    for name, width, height, scale, scheme in [
        ("desktop", 1280, 860, 1, "light"), ("dark", 1280, 860, 1, "dark"), ("phone", 360, 740, 2, "light"),
        ("phone-dark", 360, 740, 2, "dark"), ("zoomed", 640, 430, 2, "light"),
    ]:
        metrics = {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": False}
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        page = Page(driver, address)
        time.sleep(0.2)
        assert page.js("return document.documentElement.scrollWidth") <= width, name
        assert not page.errors(), name
        if pictures:
            pathlib.Path(pictures, f"{name}.png").write_bytes(driver.get_screenshot_as_png())
    driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def main(program, pictures=None):
    program = str(pathlib.Path(program).resolve())
    models = ROOT / "examples" / "models"
    with tempfile.TemporaryDirectory() as downloads:
        try:
            driver = browser(downloads)
        except WebDriverException as error:
            print(f"Chromium does not start: {error.msg}", file=sys.stderr)
            return 77
        try:
            with viewer(program, models, "spot.obj", "--up-axis", "y", "--azimuth", "30") as (address, _):
                page = Page(driver, address)
                check_turning(page)
                check_keys(page)
                check_saving(page, program, models, downloads)
                check_zooming(page, program, models)
                check_picture(page, program, models)
                check_options(page)
                assert not [entry for entry in page.errors() if "422" not in entry["message"]]
                first = driver.current_window_handle
                driver.switch_to.new_window("tab")
                other = Page(driver, address)
                other.drag(50, 0)
                other.rest()
                assert not other.errors()
                driver.close()
                driver.switch_to.window(first)
                check_foreign_page(page, address)
                check_sizes(driver, address, pictures)
            with viewer(program, models, "--expr", "sin(r)/r", "--x=-9:9", "--y=-9:9", "--samples", "60") as (address, _):
                page = Page(driver, address)
                check_surface(page)
            with viewer(program, models, "spot.obj", "--once") as (address, process):
                Page(driver, address)
                driver.get("about:blank")
                assert process.wait(20) == 0, "--once"
        finally:
            driver.quit()
    print("Chromium: turns, zooms, saves the bytes of the command line, and shows errors")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
