"""Who sits before ParaView in a test: eyes on the screen, a mouse and a keyboard. Needs Xvfb and python3-xlib."""
import pathlib
import threading
import time

from Xlib import X, XK, display
from Xlib.ext import xtest
from Xlib.protocol import event

from guicase import read_screen

VIEW = (300, 205, 720, 520)  # left, top, width, height of the inside of the 3-D view


def press_keys(screen, *names):
    """Keys of an X display together, by their names in X, the last one last."""
    keys = [screen.keysym_to_keycode(XK.string_to_keysym(name)) for name in names]
    for key in keys:
        xtest.fake_input(screen, X.KeyPress, key)
    for key in reversed(keys):
        xtest.fake_input(screen, X.KeyRelease, key)
    screen.sync()


class Person:
    """Watches the screen and acts while ParaView plays a script."""

    def __init__(self, case, folder):
        self.frame_buffer = case.frame_buffer
        self.folder = pathlib.Path(folder)
        self.display = display.Display(case.display)
        self.ended = threading.Event()  # ParaView has
        self.clicks = 0

    def await_file(self, name):
        """Returns when a file was written."""
        path = self.folder / name
        for _ in range(3000):
            ended = self.ended.wait(0.1)
            if path.exists():
                return
            if ended:
                break
        raise TimeoutError(f"{name} was not written")

    def picture(self):
        """The 3-D view's pixels."""
        width, _, pixels = read_screen(self.frame_buffer)
        left, top, columns, rows = VIEW
        return [bytes(pixels[3 * (width * y + left):3 * (width * y + left + columns)]) for y in range(top, top + rows)]

    def find_button(self):
        """The abort button: the red cross below the view. It is grey when there is nothing to abort."""
        width, height, pixels = read_screen(self.frame_buffer)
        for y in range(VIEW[1] + VIEW[3], height):
            for x in range(width):
                red, green, blue = pixels[3 * (width * y + x):3 * (width * y + x) + 3]
                if red > 180 and green < 80 and blue < 80:
                    return x, y
        return None

    def sees_progress(self):
        """Whether the status bar is filled, in blue, to the right of the abort button."""
        button = self.find_button()
        width, _, pixels = read_screen(self.frame_buffer)
        filled = 0
        for x in range(button[0] + 20, button[0] + 200) if button else ():
            red, _, blue = pixels[3 * (width * button[1] + x):3 * (width * button[1] + x) + 3]
            filled += blue > 150 and red < 110
        return filled > 20

    def await_button(self):
        """On a busy machine it takes a while until it is drawn."""
        for _ in range(50):
            time.sleep(0.2)
            button = self.find_button()
            if button:
                return button
        raise TimeoutError("the abort button is not red")

    def move(self, x, y):
        xtest.fake_input(self.display, X.MotionNotify, x=x, y=y)
        self.display.sync()

    def hold(self):
        """The mouse button, until release()."""
        xtest.fake_input(self.display, X.ButtonPress, 1)
        self.display.sync()

    def release(self):
        xtest.fake_input(self.display, X.ButtonRelease, 1)
        self.display.sync()

    def click(self, x, y, seconds=0):
        """Seconds between press and release."""
        self.move(x, y)
        self.hold()
        time.sleep(seconds)
        self.release()
        self.clicks += 1

    def await_colour(self, x, y, around=6):
        """Returns when there is something coloured on the screen: an icon that is not grey."""
        for _ in range(600):
            width, _, pixels = read_screen(self.frame_buffer)
            for row in range(y - around, y + around):
                line = pixels[3 * (width * row + x - around):3 * (width * row + x + around)]
                if any(max(line[i:i + 3]) - min(line[i:i + 3]) > 80 for i in range(0, len(line), 3)):
                    return
            if self.ended.wait(0.1):
                break
        raise TimeoutError(f"nothing coloured at ({x}, {y})")

    def press(self, *names):
        press_keys(self.display, *names)

    def press_quit(self):
        self.press("Control_L", "q")

    def close_window(self):
        """As the cross in a window's frame does."""
        atom = self.display.intern_atom
        for window in self.display.screen().root.query_tree().children:
            if (window.get_wm_name() or "").startswith("ParaView 5"):
                window.send_event(event.ClientMessage(window=window, client_type=atom("WM_PROTOCOLS"),
                                                      data=(32, [atom("WM_DELETE_WINDOW"), 0, 0, 0, 0])))
        self.display.sync()


def while_acting(person, act, play):
    """What `play()` returns while `act(person)` runs beside it, and a list of what acting failed with, which is for the test to
    tell, not for the thread."""
    failures = []

    def act_alone():
        try:
            act(person)
        except Exception as failure:
            failures.append(failure)

    acting = threading.Thread(target=act_alone)
    acting.start()
    played = play()
    person.ended.set()
    acting.join()
    return played, failures
