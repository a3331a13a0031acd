// Shows the viewer with one layout: the live server or the recording at `url`, and the messages of `topic`.
const asked = new URLSearchParams(location.search);
const url = asked.get("url");
const panels = {
  "3D!world": { topics: { "/scene": { visible: true } }, followTf: "world",
                cameraState: { distance: 1.2, phi: 60, thetaOffset: 45, targetOffset: [0, 0, 0], target: [0, 0, 0],
                               targetOrientation: [0, 0, 0, 1], perspective: true, fovy: 45, near: 0.01, far: 100 },
                scene: { transforms: { showLabel: false, axisScale: 0.02, lineWidth: 0 } } },
  "RosOut!log": {},
  "Parameters!set": {},
  "RawMessages!raw": { topicPath: asked.get("topic") },
};
const column = (first, second) => ({ direction: "column", first, second });
const data = { configById: panels, globalVariables: {}, userNodes: {}, playbackConfig: { speed: 1 },
               layout: { direction: "row", first: "3D!world", splitPercentage: 60,
                         second: column("RosOut!log", column("Parameters!set", "RawMessages!raw")) } };
const layouts = new Map([["one", { id: "one", name: "one", permission: "CREATOR_WRITE", baseline: { data } }]]);
localStorage.setItem("studio.profile-data", JSON.stringify({ currentLayoutId: "one" }));

const storage = {
  list: async () => [...layouts.values()],
  get: async (_, id) => layouts.get(id),
  put: async (_, layout) => layouts.set(layout.id, layout).get(layout.id),
  delete: async (_, id) => void layouts.delete(id),
  importLayouts: async () => undefined,
};
const configuration = { get: (key) => ({ colorScheme: "light" })[key], set: async () => undefined,
                        addChangeListener: () => undefined, removeChangeListener: () => undefined };
const link = new URL(location.origin);
link.searchParams.set("ds", url.startsWith("ws:") ? "foxglove-websocket" : "remote-file");
link.searchParams.set("ds.url", url);

initI18n().then(() => ReactDOM.render(React.createElement(App, {
  deepLinks: [link.href], appConfiguration: configuration,
  dataSources: [new FoxgloveWebSocketDataSourceFactory(), new RemoteDataSourceFactory()],
  layoutStorage: storage, extensionLoaders: [], enableGlobalCss: true,
}), document.getElementById("root")));
