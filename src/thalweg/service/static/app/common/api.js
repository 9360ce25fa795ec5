// Requests to the service. Errors are problem details with asked, possible, remedy and field.

const BASE = "/api/v1";

export const hasEnded = (state) => ["done", "failed", "cancelled"].includes(state);

export class Problem extends Error {
  constructor(details) {
    super(details.detail || details.asked || "The request failed.");
    Object.assign(this, { possible: "", remedy: "", field: null }, details);
  }
}

async function answer(request) {
  let response;
  try {
    response = await request;
  } catch {
    throw new Problem({
      asked: "The service does not answer.",
      possible: "Plans that were started go on when it runs again.",
      remedy: "Check that 'thalweg serve' is running, then try again.",
    });
  }
  if (response.ok) return response;
  let details;
  try {
    details = await response.json();
  } catch {
    details = { asked: `The service answered ${response.status}.` };
  }
  throw new Problem(details);
}

export async function get(path) {
  return (await answer(fetch(BASE + path))).json();
}

export async function getBuffer(path) {
  return (await answer(fetch(BASE + path))).arrayBuffer();
}

export async function post(path, data, headers = {}) {
  const body = JSON.stringify(data);
  return (await answer(fetch(BASE + path, { method: "POST", headers: { "Content-Type": "application/json", ...headers }, body }))).json();
}

// Start a job; a repeated request after a lost answer starts no second one.
export async function start(path, request) {
  return post(path, request, { "Idempotency-Key": crypto.randomUUID?.() || String(Math.random()) });
}

export async function remove(path) {
  return answer(fetch(BASE + path, { method: "DELETE" }));
}

export async function uploadForm(path, file) {
  const form = new FormData();
  form.append("file", file);
  return (await answer(fetch(BASE + path, { method: "POST", body: form }))).json();
}

export function uploadSea(file, onProgress) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", `${BASE}/seas?name=${encodeURIComponent(file.name)}`);
    request.responseType = "json";
    request.upload.onprogress = (event) => event.lengthComputable && onProgress(event.loaded / event.total);
    request.onload = () => (request.status === 201 ? resolve(request.response) : reject(new Problem(request.response || { asked: `The service answered ${request.status}.` })));
    request.onerror = () => reject(new Problem({ asked: "The upload was interrupted.", remedy: "Try again." }));
    request.send(file);
  });
}

// Follow a job until its final state; the browser reconnects with Last-Event-ID by itself.
export function follow(id, handlers) {
  const source = new EventSource(`${BASE}/plans/${id}/events`);
  for (const kind of ["state", "stage", "route", "front", "progress"]) {
    source.addEventListener(kind, (event) => {
      const data = JSON.parse(event.data);
      const last = kind === "state" && hasEnded(data.state);
      if (last) source.close();
      handlers[kind]?.(data);
    });
  }
  source.onerror = () => handlers.waiting?.();
  source.onopen = () => handlers.open?.();
  return () => source.close();
}

export const fileAddress = (id, number, form) => `${BASE}/plans/${id}/routes/${number}.${form}`;
export const tableAddress = (id, name) => `${BASE}/plans/${id}/tables/${name}.csv`;
export const resultAddress = (id) => `${BASE}/plans/${id}/result`;
