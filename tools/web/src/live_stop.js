// The stop: a button, a question, and what has been asked. Whether anything stands is not said here: the program says it when it has read it back.
import { button, element } from "./dom.js";

/** @param send  () -> promise of the program's answer. */
export function stopPanel(send) {
  const said = element("p", { class: "note", role: "status", id: "stop-said" }, "");
  const dialog = element("dialog", { "aria-labelledby": "stop-question" });
  const ask = button("Stop the measurement", () => dialog.showModal(), { class: "stop", id: "stop" });
  const sure = button("Stop", async () => {
    dialog.close();
    said.textContent = "Asking the program to stop";
    try {
      const answer = await send();
      if (answer.status !== 202) throw new Error(await answer.text());
    } catch (error) {
      said.textContent = `The program did not take the stop (${error.message}). Use Ctrl-C in the terminal, or the emergency stop`;
    }
  }, { class: "stop", id: "stop-sure" });
  const question = element("h2", { id: "stop-question" }, "Stop the measurement?");
  const means = element("p", {}, "The program commands whatever moves to stop, as after Ctrl-C, and asks it whether it stands. Readings so far are kept.");
  dialog.append(question, means, element("div", { class: "tools" }, sure, button("Cancel", () => dialog.close(), { id: "stop-not" })));
  return {
    element: element("section", { class: "halt", "aria-label": "Stop" }, ask, said, dialog),
    /** What is stopped, where it is no measurement. */
    isOf: (name, asks, says) => {
      ask.textContent = name;
      question.textContent = asks;
      means.textContent = says;
    },
    asked: () => (said.textContent = `The program was asked to stop at ${new Date().toLocaleTimeString()}; it has not said yet what came of it`),
    over: () => {
      dialog.close();
      ask.disabled = true;
      said.textContent = "";
    },
  };
}
