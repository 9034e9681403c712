// Formulas of a surface, with errors under the character, and sliders for parameters.

class Formulas {
  constructor(section, changed) {
    this.section = section;
    this.changed = changed;
    this.texts = [];
    /** Parameters: name to { value, low, high }. */
    this.parameters = new Map();
  }

  build(about, values) {
    this.section.hidden = !about.formulas;
    this.texts = about.formulas ? [...about.subjects] : [];
    this.parameters.clear();
    for (const text of [values.set ?? []].flat()) {
      const [name, value] = text.split("=").map((part) => part.trim());
      this.add(name, Number(value));
    }
    this.show();
  }

  /** The options for it. */
  options() {
    const options = {};
    if (this.texts.length) options.expr = this.texts;
    const set = [...this.parameters].map(([name, { value }]) => `${name}=${brief(value)}`);
    if (set.length) options.set = set;
    return options;
  }

  add(name, value = 1) {
    const size = Math.max(1, Math.abs(value));
    this.parameters.set(name, { value, low: -2 * size, high: 2 * size });
  }

  show() {
    const fields = this.texts.map((text, index) => this.field(text, index));
    const more = make("button", { type: "button", className: "quiet", textContent: "Add a sheet",
      onclick: () => { this.texts.push("0"); this.show(); this.changed(); } });
    const sliders = [...this.parameters.keys()].map((name) => this.slider(name));
    this.section.replaceChildren(...fields, ...sliders, more);
  }

  field(text, index) {
    const id = `formula-${index}`;
    const error = make("pre", { className: "formula-error", id: `${id}-error`, hidden: true });
    error.setAttribute("role", "alert");
    const input = make("input", { id, type: "text", className: "formula", value: text, spellcheck: false,
      autocomplete: "off", "aria-describedby": error.id });
    input.addEventListener("input", () => {
      this.texts[index] = input.value;
      this.changed();
    });
    const label = make("label", { htmlFor: id, textContent: this.texts.length > 1 ? `z${index + 1} =` : "z =" });
    const line = make("div", { className: "formula-line" }, label, input);
    if (this.texts.length > 1) {
      line.append(make("button", { type: "button", className: "quiet", textContent: "×",
        "aria-label": `Remove sheet ${index + 1}`,
        onclick: () => { this.texts.splice(index, 1); this.show(); this.changed(); } }));
    }
    return make("div", { className: "row" }, line, error);
  }

  slider(name) {
    const parameter = this.parameters.get(name);
    const id = `parameter-${name}`;
    const step = (parameter.high - parameter.low) / 200;
    const number = make("input", { type: "text", inputMode: "decimal", className: "short", value: brief(parameter.value),
      "aria-label": `Value of ${name}` });
    const range = make("input", { type: "range", id, min: parameter.low, max: parameter.high, step, value: parameter.value });
    range.addEventListener("input", () => {
      parameter.value = Number(Number(range.value).toPrecision(4));
      number.value = brief(parameter.value);
      this.changed();
    });
    number.addEventListener("change", () => {
      const value = Number(number.value);
      if (!Number.isFinite(value)) return;
      this.add(name, value);
      this.show();
      this.changed();
    });
    return make("div", { className: "row slider" }, make("label", { htmlFor: id, textContent: name }), range, number,
      make("button", { type: "button", className: "quiet", textContent: "×", "aria-label": `Remove ${name}`,
        onclick: () => { this.parameters.delete(name); this.show(); this.changed(); } }));
  }

  /** Shows an error under its character; returns whether it is about a formula. */
  fail(about) {
    for (const error of this.section.querySelectorAll(".formula-error")) {
      error.hidden = true;
      error.previousSibling.querySelector("input").removeAttribute("aria-invalid");
    }
    if (about?.option !== "expr" || about.index === undefined) return false;
    const error = document.getElementById(`formula-${about.index}-error`);
    if (!error) return false;
    error.textContent = `${" ".repeat(Math.max(0, (about.column ?? 1) - 1))}▲\n${about.error}`;
    error.hidden = false;
    error.previousSibling.querySelector("input").setAttribute("aria-invalid", "true");
    return true;
  }
}
