// Requests to the server, and what its answers hold.

/** An answer from the server that is not a drawing. */
class Fault extends Error {
  constructor(status, about) {
    super(about.error ?? `the server answered ${status}`);
    this.status = status;
    this.about = about;
  }
}

class Server {
  constructor(token) {
    this.token = token;
    this.page = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16)).join("");
    this.seq = 0;
  }

  async request(path, body, signal) {
    const headers = { "X-Hiddenline-Token": this.token };
    const method = body === undefined ? "GET" : "POST";
    let answer;
    try {
      answer = await fetch(path, { method, headers, body, signal, cache: "no-store" });
    } catch (error) {
      if (error.name === "AbortError") throw error;
      throw new Fault(0, { error: "hiddenline has stopped; start it again and open the address it prints" });
    }
    if (!answer.ok) {
      const about = await answer.json().catch(() => ({}));
      throw new Fault(answer.status, about);
    }
    return answer;
  }

  /** A drawing; `asked` has camera, options and want. */
  async draw(asked, signal) {
    const seq = ++this.seq;
    const start = performance.now();
    const body = JSON.stringify({ seq, page: this.page, ...asked });
    const answer = await this.request("/api/draw", body, signal);
    const facts = JSON.parse(answer.headers.get("X-Hiddenline-Stats"));
    const octets = await answer.arrayBuffer();
    return { ...parse(octets), facts, ms: performance.now() - start };
  }

  /** A file to save, and its name. */
  async file(asked) {
    const body = JSON.stringify({ seq: ++this.seq, page: this.page, ...asked });
    const answer = await this.request("/api/file", body);
    const { name } = JSON.parse(answer.headers.get("X-Hiddenline-Stats"));
    return { name, blob: await answer.blob() };
  }

  /** Shows another model. */
  async model(file) {
    await this.request(`/api/model?name=${encodeURIComponent(file.name)}`, file);
  }

  /** Calls `listen` with each event, until the server ends. */
  async events(listen) {
    const answer = await this.request(`/api/events?page=${this.page}`);
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return;
      const lines = (rest + value).split("\n");
      rest = lines.pop();
      for (const line of lines) if (line) listen(JSON.parse(line));
    }
  }
}

/** The arrays in the octets of a drawing, without copying. */
function parse(octets) {
  const words = new Uint32Array(octets);
  // "HLV1", little-endian.
  if (words[0] !== 0x31564c48) throw new Fault(0, { error: "the answer is not a drawing" });
  const [, seq, flags, nGroups, nStrokes, nPoints] = words;
  const groups = [];
  for (let k = 0; k < nGroups; k++) {
    const [pen, kind, , first] = words.subarray(6 + 4 * k, 10 + 4 * k);
    groups.push({ pen, kind, first });
  }
  groups.forEach((group, k) => { group.end = groups[k + 1]?.first ?? nStrokes; });
  const at = 6 + 4 * nGroups;
  const isInSpace = (flags & 2) !== 0;
  return {
    seq,
    isInSpace,
    groups,
    starts: words.subarray(at, at + nStrokes + 1),
    points: new Float32Array(octets, 4 * (at + nStrokes + 1), nPoints * (isInSpace ? 3 : 2)),
  };
}
