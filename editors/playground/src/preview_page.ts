// The preview's page, in a frame of the playground: its keys and its style are its own.
import { frameConnection } from "../../preview/page/frame";
import { followBrowserColours } from "../../preview/page/colours";
import { startPreview } from "../../preview/page/start";

followBrowserColours();
startPreview(frameConnection("pydslrep.preview"));
