// Pause and resume. The page says that a measurement is paused when the program has said so, and it says so when it has seen that everything stands.
import { button, element } from "./dom.js";

const kWords = {
  asked: () => "The program was asked to pause; it does so behind the next reading, when everything stands",
  not_yet: ({ why }) => `Not paused yet: ${why}. The program tries again behind the next readings`,
  paused: ({ reading }) => `Paused at reading ${reading}: everything stands`,
  restless: ({ why }) => `Paused, but not at rest: ${why}. Look at the bench`,
  over: ({ reading }) => `Resumed behind reading ${reading}`,
};

/** @param send  (path) -> promise of the program's answer. */
export function pausePanel(send) {
  const said = element("p", { class: "note", role: "status", id: "pause-said" }, "");
  let wanted = false;
  const toggle = button("Pause", async () => {
    const path = wanted ? "/resume" : "/pause";
    try {
      const answer = await send(path);
      if (answer.status !== 202) throw new Error(await answer.text());
    } catch (error) {
      said.textContent = `The program did not take it (${error.message})`;
    }
  }, { class: "pause", id: "pause", hidden: true });
  const want = (yes) => {
    wanted = yes;
    toggle.textContent = yes ? "Resume" : "Pause";
  };
  return {
    element: element("section", { class: "halt", "aria-label": "Pause" }, toggle, said),
    offer: (can) => (toggle.hidden = !can),
    /** Somebody has pressed the button, here or on another page. */
    asked: (what) => {
      want(what === "pause");
      said.textContent = wanted ? kWords.asked() : "";
    },
    /** The program says what came of it. */
    heard: (event) => {
      said.dataset.state = event.state;
      said.textContent = kWords[event.state]?.(event) ?? "";
    },
    over: () => {
      toggle.disabled = true;
      said.textContent = "";
    },
  };
}
